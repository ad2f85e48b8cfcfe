/** The lens models: as OpenCV has them, one to one inside their domain, and silent outside it. */

import {
  bend,
  domainRadius,
  idealAt,
  type Lens,
  type LensModel,
  type Pair,
  project,
  sameLens,
  unbend,
} from "../../web/src/lens";
import golden from "../golden/project.json";
import { forSeeds, type Random } from "./random";

const MODELS: readonly LensModel[] = ["none", "plumb_bob", "rational_polynomial", "equidistant"];
/** As large as each coefficient of an ordinary lens gets. */
const SPREAD: Readonly<Record<LensModel, readonly number[]>> = {
  none: [],
  plumb_bob: [0.3, 0.1, 0.002, 0.002, 0.03],
  rational_polynomial: [0.3, 0.1, 0.002, 0.002, 0.02, 0.3, 0.1, 0.02],
  equidistant: [0.05, 0.01, 0.005, 0.001],
};

function randomLens(random: Random, model: LensModel): Lens {
  const coefficients = SPREAD[model].map((spread) => random.between(-spread, spread));
  return {
    width_px: 640,
    height_px: 480,
    fx_px: random.between(300, 900),
    fy_px: random.between(300, 900),
    cx_px: random.between(280, 360),
    cy_px: random.between(200, 280),
    model,
    coefficients: [...coefficients, ...new Array<number>(8 - coefficients.length).fill(0)],
  };
}

/** Return ideal coordinates well inside the domain: the tangential terms bend the last rim before the fold. */
function inside(random: Random, lens: Lens): Pair {
  const angle = random.between(0, 2 * Math.PI);
  const r = random.between(0, 0.8 * Math.min(domainRadius(lens), 4));
  return [r * Math.cos(angle), r * Math.sin(angle)];
}

function gap([ax, ay]: Pair, [bx, by]: Pair): number {
  return Math.hypot(ax - bx, ay - by);
}

function found<T>(value: T | null): T {
  if (value === null) throw new Error("nothing was found");
  return value;
}

test.each(golden.lenses)("points lie where OpenCV sees them: $lens.model", ({ lens, points_cam_m, pixels }) => {
  const ours: Lens = { ...lens, model: lens.model as LensModel };
  expect(points_cam_m.length).toBeGreaterThan(20);
  points_cam_m.forEach(([x = 0, y = 0, z = 0], i) => {
    const [u = 0, v = 0] = pixels[i] ?? [];
    expect(gap(found(project(ours, [x, y, z])), [u, v])).toBeLessThan(1e-5);
  });
});

describe.each(MODELS)("%s", (model) => {
  test("unbending undoes bending", () => {
    forSeeds(60, (random) => {
      const lens = randomLens(random, model);
      const ideal = inside(random, lens);
      expect(gap(found(unbend(lens, bend(lens, ideal))), ideal)).toBeLessThan(1e-6);
    });
  });

  test("a pixel's ray is seen at that pixel", () => {
    forSeeds(60, (random) => {
      const lens = randomLens(random, model);
      const pixel: Pair = [random.between(0, 639), random.between(0, 479)];
      const ideal = idealAt(lens, pixel);
      if (ideal === null) return; // outside the lens model; the test below says where that may be
      const depth_m = random.between(0.1, 100);
      const seen = found(project(lens, [ideal[0] * depth_m, ideal[1] * depth_m, depth_m]));
      expect(gap(seen, pixel)).toBeLessThan(1e-5);
    });
  });

  test("every pixel of a picture that the domain covers has a ray", () => {
    forSeeds(60, (random) => {
      const lens = randomLens(random, model);
      const [x, y] = inside(random, lens);
      const pixel = found(project(lens, [x, y, 1]));
      expect(gap(found(idealAt(lens, pixel)), [x, y])).toBeLessThan(1e-6);
    });
  });

  test("only what is in front of the camera, and its direction alone, makes a pixel", () => {
    forSeeds(60, (random) => {
      const lens = randomLens(random, model);
      const [x, y] = inside(random, lens);
      const near = found(project(lens, [x, y, 1]));
      const far = found(project(lens, [x * 70, y * 70, 70]));
      expect(gap(near, far)).toBeLessThan(1e-6);
      expect(project(lens, [x, y, -1])).toBeNull();
      expect(project(lens, [x, y, 0])).toBeNull();
      expect(project(lens, [Number.NaN, y, 1])).toBeNull();
      expect(project(lens, [x, y, Number.NaN])).toBeNull();
    });
  });

  test("along a ray of the domain the picture only goes outwards, and past it there is nothing", () => {
    forSeeds(30, (random) => {
      const lens = { ...randomLens(random, model) };
      const straight: Lens = { ...lens, coefficients: lens.coefficients.map((k, i) => (i === 2 || i === 3 ? 0 : k)) };
      const used = model === "equidistant" ? lens : straight; // tangential terms are no part of the domain
      const radius = domainRadius(used);
      const angle = random.between(0, 2 * Math.PI);
      const along = (r: number): Pair => [r * Math.cos(angle), r * Math.sin(angle)];
      let last = 0;
      for (let step = 1; step <= 40; step++) {
        const bent = Math.hypot(...bend(used, along((radius * step) / 40)));
        expect(bent).toBeGreaterThan(last);
        last = bent;
      }
      const [x, y] = along(radius * 1.01);
      expect(project(used, [x, y, 1])).toBeNull();
    });
  });

  test("the axis is seen at the principal point", () => {
    forSeeds(10, (random) => {
      const lens = randomLens(random, model);
      expect(project(lens, [0, 0, 3])).toEqual([lens.cx_px, lens.cy_px]);
    });
  });
});

test("a lens that folds back shows nothing from beyond its fold", () => {
  const size = { width_px: 640, height_px: 480, fx_px: 500, fy_px: 500, cx_px: 320, cy_px: 240 };
  const folding: Lens = { ...size, model: "plumb_bob", coefficients: [-0.3, 0, 0, 0, 0, 0, 0, 0] };
  const fold = 1 / Math.sqrt(0.9); // where r - 0.3 r³ turns back
  expect(domainRadius(folding)).toBeGreaterThan(0.99 * fold);
  expect(domainRadius(folding)).toBeLessThanOrEqual(fold);
  expect(project(folding, [1.5, 0, 1])).toBeNull();
  expect(unbend(folding, [5, 0])).toBeNull();
});

test("a lens is the same as its copy, and another when any number or the model differs", () => {
  forSeeds(20, (random) => {
    const lens = randomLens(random, "rational_polynomial");
    expect(sameLens(lens, { ...lens, coefficients: [...lens.coefficients] })).toBe(true);
    for (const key of ["width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px"] as const)
      expect(sameLens(lens, { ...lens, [key]: lens[key] + 1 })).toBe(false);
    const changed = lens.coefficients.map((value, i) => (i === random.below(8) ? value + 1e-7 : value));
    expect(sameLens(lens, { ...lens, coefficients: changed })).toBe(
      changed.every((v, i) => v === lens.coefficients[i]),
    );
    expect(sameLens(lens, { ...lens, model: "equidistant" })).toBe(false);
  });
});
