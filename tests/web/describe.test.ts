/** The view in words, beside shapely's of the same places. */

import { readFileSync } from "node:fs";
import { describe as describeView, type Solid, type Standpoint } from "../../web/src/describe";
import { descriptionWords } from "../../web/src/description";
import { speak } from "../../web/src/language/speech";
import { forSeeds } from "./random";

interface Golden {
  readonly half_rad: number;
  readonly solids: readonly Solid[];
  readonly views: readonly {
    readonly eye_m: readonly [number, number, number];
    readonly heading_rad: number;
    readonly at: string | null;
    readonly sights: readonly { readonly id: string; readonly side: string; readonly distance_m: number }[];
  }[];
}

const golden: Golden = JSON.parse(readFileSync(new URL("../golden/description.json", import.meta.url), "utf8"));
const WALL: Solid = {
  id: "wall",
  footprint: [
    [-50, 22],
    [50, 22],
    [50, 23],
    [-50, 23],
  ],
  base_m: 0,
  height_m: 6,
};
const NORTH: Standpoint = { e_m: 0, n_m: 0, u_m: 1.65, heading_rad: 0, half_rad: Math.PI / 6 };

afterEach(() => speak("en"));

test.each(golden.views.map((view, i) => [i, view] as const))("view %i is as shapely has it", (_i, view) => {
  const [e_m, n_m, u_m] = view.eye_m;
  const from = { e_m, n_m, u_m, heading_rad: view.heading_rad, half_rad: golden.half_rad };
  const seen = describeView(from, golden.solids);
  expect(seen.at).toBe(view.at);
  expect(seen.sights.map(({ id, side }) => [side, id])).toEqual(view.sights.map(({ id, side }) => [side, id]));
  seen.sights.forEach(({ distance_m }, i) => {
    expect(distance_m).toBeCloseTo(view.sights[i]?.distance_m ?? Number.NaN, 6);
  });
});

test("what is high hides what is behind it, what is low does not, and a tower rises over a wall", () => {
  const behind = (id: string, height_m: number): Solid => ({ ...shifted(WALL, 10), id, height_m });
  const ids = (solids: readonly Solid[]): string[] => describeView(NORTH, solids).sights.map(({ id }) => id);
  expect(ids([WALL, behind("house", 6)])).toEqual(["wall"]);
  expect(ids([{ ...WALL, height_m: 1 }, behind("house", 6)])[0]).toBe("house");
  expect(ids([WALL, behind("tower", 40)])[0]).toBe("tower");
});

test("turning everything about the eye changes nothing but the heading", () => {
  forSeeds(20, (random) => {
    const turn = random.between(0, 2 * Math.PI);
    const turned = golden.solids.map((solid) => ({
      ...solid,
      footprint: solid.footprint.map(([e, n]): [number, number] => [
        e * Math.cos(turn) + n * Math.sin(turn),
        n * Math.cos(turn) - e * Math.sin(turn),
      ]),
    }));
    const before = describeView(NORTH, golden.solids);
    const after = describeView({ ...NORTH, heading_rad: turn }, turned);
    expect(after.sights.map(({ id, side }) => [side, id])).toEqual(before.sights.map(({ id, side }) => [side, id]));
  });
});

test("the words name the direction, what is seen and how far, in both languages", () => {
  const names = new Map([["wall", "Basilica Stoa"]]);
  const seen = describeView(NORTH, [WALL]);
  expect(descriptionWords(seen, names)).toBe("You face north. Ahead, 22 metres away: Basilica Stoa.");
  expect(descriptionWords({ ...seen, sights: [], heading_rad: -Math.PI / 2, above_m: 30 }, names)).toBe(
    "You face west. You look down from 30 metres up. Nothing of the square is in view.",
  );
  expect(
    descriptionWords({ ...seen, at: "wall", sights: [{ id: "wall", side: "left", distance_m: 0.2 }] }, names),
  ).toBe("You face north. To the left, 1 metre away: Basilica Stoa. Where you stand: Basilica Stoa.");
  speak("tr");
  expect(descriptionWords(seen, names)).toBe("Kuzeye bakıyorsunuz. Karşınızda, 22 metre ileride: Basilica Stoa.");
});

function shifted(solid: Solid, by_m: number): Solid {
  return { ...solid, footprint: solid.footprint.map(([e, n]) => [e, n + by_m] as const) };
}
