/** The start page's values: views and their addresses, flights, intents, the tour, and what is found by words. */

import { hashOf, readAddress, type Shown } from "../../web/src/browse/address";
import { aheadOf, type Eye, eyeOf, looking, pointAhead, poseOf, STEEPEST_RAD, turnTo } from "../../web/src/browse/eye";
import { found, overlooking, plainText } from "../../web/src/browse/finding";
import { flightOf } from "../../web/src/browse/flight";
import { isStill, ofGamepad, ofKeys, ofStick, STILL, together } from "../../web/src/browse/intent";
import { after, begun, moved, stayOf, toggled } from "../../web/src/browse/journey";
import { BEST, breakAfter, Pace, STEPS } from "../../web/src/browse/pace";
import { lengthsOf } from "../../web/src/browse/span";
import { isRigid, transform } from "../../web/src/frames";
import type { Place } from "../../web/src/plan";
import type { Monument } from "../../web/src/site";
import { forSeeds, type Random } from "./random";

function eye(random: Random): Eye {
  return {
    place_site_m: random.point(200),
    heading_rad: random.between(0, 2 * Math.PI),
    pitch_rad: random.between(-STEEPEST_RAD, STEEPEST_RAD),
  };
}

function close(a: Eye, b: Eye, metres: number, radians: number): void {
  const [p, q] = [a.place_site_m, b.place_site_m];
  expect(Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2])).toBeLessThan(metres);
  expect(Math.abs(turnTo(a.heading_rad, b.heading_rad))).toBeLessThan(radians);
  expect(Math.abs(a.pitch_rad - b.pitch_rad)).toBeLessThan(radians);
}

test("an eye and its pose are the same, and what lies ahead is in the middle", () => {
  forSeeds(50, (random) => {
    const one = eye(random);
    const T_site_cam = poseOf(one);
    expect(isRigid(T_site_cam, 1e-9)).toBe(true);
    close(eyeOf(T_site_cam), one, 1e-9, 1e-9);
    const ahead = transform(T_site_cam, [0, 0, 7]);
    pointAhead(one, 7).forEach((value, i) => {
      expect(value).toBeCloseTo(ahead[i] ?? Number.NaN, 9);
    });
    expect(transform(T_site_cam, [0, -1, 0])[2]).toBeGreaterThan(one.place_site_m[2]); // the picture is upright
  });
});

test("looking north-east and up is told as such", () => {
  const one = looking([0, 0, 0], [5, 5, Math.hypot(5, 5)]);
  expect(one.heading_rad).toBeCloseTo(Math.PI / 4, 9);
  expect(one.pitch_rad).toBeCloseTo(Math.PI / 4, 9);
  expect(aheadOf(one)[2]).toBeCloseTo(Math.SQRT1_2, 9);
});

test("a view comes back from its address to the centimetre", () => {
  forSeeds(100, (random) => {
    const shown: Shown = {
      eye: eye(random),
      way: (["orbit", "walk", "fly", null] as const)[random.below(4)] ?? null,
      about_m: random.below(2) ? random.between(1, 300) : null,
      past: random.below(2) ? random.between(0, 1) : null,
      hour: random.below(2) ? random.between(0, 24) : null,
      isTinted: random.below(2) === 1,
      variants: new Map(random.below(2) ? [["memmius", "tower"]] : []),
      stop: random.below(2) ? "temple" : null,
    };
    const again = readAddress("", hashOf(shown));
    if (!again.eye || !shown.eye) throw new Error("an eye was given");
    close(again.eye, shown.eye, 0.01, 2e-4);
    for (const name of ["about_m", "past", "hour"] as const) {
      if (shown[name] === null) expect(again[name]).toBeNull();
      else expect(again[name]).toBeCloseTo(shown[name], 1);
    }
    expect([again.way, again.isTinted, again.stop]).toEqual([shown.way, shown.isTinted, shown.stop]);
    expect([...again.variants]).toEqual([...shown.variants]);
    expect(hashOf(again)).toBe(hashOf(readAddress("", hashOf(again)))); // a link of a link is that link
  });
});

test("whatever cannot be read in an address is as if it was not there", () => {
  const nothing = readAddress("", "");
  for (const hash of [
    "#at=1,2",
    "#at=1,2,NaN",
    "#at=1,2,1e9&look=3,4",
    "#at=1,2,3&look=10,120",
    "#past=2",
    "#hour=-1",
    "#hour=",
    "#way=teleport",
    "#about=-3",
    "#view=../../etc",
    "#variants=a:<b>,:c,d",
    "#%%%",
  ])
    expect(readAddress("", hash)).toEqual(nothing);
});

test("a question is read as well, and what stands behind the # goes before it", () => {
  expect(readAddress("?model=today&evidence=1&view=temple", "")).toMatchObject({
    past: 0,
    isTinted: true,
    stop: "temple",
  });
  expect(readAddress("?model=today&view=temple", "#past=0.5&view=square")).toMatchObject({ past: 0.5, stop: "square" });
});

test("a flight begins and ends where it should, jumps nowhere, and rises over what lies between", () => {
  forSeeds(30, (random) => {
    const [from, to] = [eye(random), eye(random)];
    const flight = flightOf(from, to, false);
    close(flight.at(0), from, 1e-9, 1e-9);
    close(flight.at(flight.duration_ms), to, 1e-9, 1e-9);
    close(flight.at(flight.duration_ms - 0.5), to, 0.01, 0.01);
    const far = Math.hypot(...[0, 1, 2].map((i) => (to.place_site_m[i] ?? 0) - (from.place_site_m[i] ?? 0)));
    for (let ms = 0; ms < flight.duration_ms; ms += 16)
      close(flight.at(ms), flight.at(ms + 16), 0.05 * far + 0.5, 0.15);
    expect(flight.duration_ms).toBeLessThan(4000);
  });
  const level = flightOf(looking([0, 0, 2], [9, 0, 2]), looking([150, 0, 2], [160, 0, 2]), false);
  expect(level.at(level.duration_ms / 2).place_site_m[2]).toBeGreaterThan(20);
});

test("a turn goes the shorter way", () => {
  const flight = flightOf(
    { place_site_m: [0, 0, 0], heading_rad: 0.1, pitch_rad: 0 },
    { place_site_m: [0, 0, 0], heading_rad: 6.2, pitch_rad: 0 },
    false,
  );
  const middle = flight.at(flight.duration_ms / 2).heading_rad;
  expect(Math.min(middle, 2 * Math.PI - middle)).toBeLessThan(0.1);
});

test("who wants little motion is there at once", () => {
  const to = looking([50, 0, 2], [0, 0, 2]);
  const flight = flightOf(looking([0, 0, 2], [9, 0, 2]), to, true);
  expect(flight.duration_ms).toBe(0);
  expect(flight.at(0)).toEqual(to);
});

test("keys, sticks and gamepads want the same things", () => {
  expect(ofKeys(new Set(["KeyW", "KeyA"]))).toEqual({ ...STILL, ahead: 1, right: -1 });
  expect(ofKeys(new Set(["ArrowUp", "KeyW", "ShiftLeft"]))).toEqual({ ...STILL, ahead: 1, hurry: true });
  expect(isStill(ofKeys(new Set(["KeyW", "KeyS", "KeyX"])))).toBe(true);
  expect(isStill(ofStick(0.1, -0.1))).toBe(true);
  expect(ofStick(0, 1)).toEqual({ ...STILL, ahead: 1, hurry: true });
  expect(ofStick(0, 0.6).hurry).toBe(false);
  expect(ofGamepad([0, -1, 1, 0], [])).toEqual({ ...STILL, ahead: 1, turn: 1 });
  expect(ofGamepad([0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0.5, 0])).toEqual({ ...STILL, up: -0.5 });
  expect(isStill(ofGamepad([], []))).toBe(true);
  expect(isStill(ofGamepad([Number.NaN, Number.NaN], [Number.NaN]))).toBe(true);
});

test("no intent is stronger than all of one", () => {
  forSeeds(30, (random) => {
    const some = [0, 1, 2].map(() => ofStick(random.between(-1, 1), random.between(-1, 1)));
    const sum = together([...some, ofKeys(new Set(["KeyW"]))]);
    for (const axis of ["ahead", "right", "up", "turn", "tilt"] as const) {
      expect(Math.abs(sum[axis])).toBeLessThanOrEqual(1);
    }
  });
});

test("a tour stays at a stop as long as its text is read, goes on, and stops at its end", () => {
  const stay_ms = stayOf("one two three ".repeat(20));
  expect(stay_ms).toBeGreaterThan(20_000);
  expect(stayOf(null)).toBeGreaterThan(3000);
  let tour = begun();
  tour = after(tour, stay_ms - 1, stay_ms, 3);
  expect(tour.index).toBe(0);
  tour = after(tour, 2, stay_ms, 3);
  expect(tour).toEqual({ index: 1, plays: true, stood_ms: 0 });
  tour = toggled(tour, 3, stay_ms);
  expect(after(tour, 10 * stay_ms, stay_ms, 3)).toEqual(tour);
  tour = moved(moved(tour, 1, 3), 1, 3);
  expect(tour.index).toBe(2);
  tour = after(toggled(tour, 3, stay_ms), stay_ms, stay_ms, 3);
  expect(tour).toEqual({ index: 2, plays: false, stood_ms: stay_ms });
  expect(toggled(tour, 3, stay_ms)).toEqual(begun());
  expect(moved(begun(), -1, 3).index).toBe(0);
});

function monument(
  id: string,
  name: string,
  footprint: readonly Place[] = [
    [0, 0],
    [10, 0],
    [10, 6],
  ],
): Monument {
  return {
    id,
    name,
    footprint,
    evidence: null,
    sources: [],
    caption: null,
    isReviewed: true,
    variants: [],
    defaultVariant: null,
    base_m: 0,
    height_m: 5,
  };
}

test("a monument is found without its capitals and marks, in the order of names", () => {
  const all = [
    monument("fountain", "Çeşme"),
    monument("basilica", "Bazilika"),
    monument("altar", "Altar"),
    monument("x", "Çatı", []),
  ];
  expect(found(all, "", "tr").map(({ id }) => id)).toEqual(["altar", "basilica", "fountain"]);
  expect(found(all, "CESM", "tr").map(({ id }) => id)).toEqual(["fountain"]);
  expect(found(all, "ka baz", "tr").map(({ id }) => id)).toEqual(["basilica"]);
  expect(found(all, "fountain", "tr").map(({ id }) => id)).toEqual(["fountain"]);
  expect(found(all, "zeppelin", "tr")).toEqual([]);
  expect(plainText("Kapısı")).toBe("kapisi");
});

test("a monument is overlooked from the middle of the square, all of it in the picture", () => {
  forSeeds(30, (random) => {
    const [e, n] = random.point(100);
    const size = random.between(3, 30);
    const outline: readonly Place[] = [
      [e - size, n - 2],
      [e + size, n - 2],
      [e + size, n + 2],
      [e - size, n + 2],
    ];
    const { eye: from, about_m } = overlooking(outline, [0, 0]);
    const middle = pointAhead(from, about_m);
    expect(Math.hypot(middle[0] - e, middle[1] - n)).toBeLessThan(1e-6);
    for (const [ce, cn] of outline) {
      const bearing_rad = Math.atan2(ce - from.place_site_m[0], cn - from.place_site_m[1]);
      expect(Math.abs(turnTo(from.heading_rad, bearing_rad))).toBeLessThan(0.75);
    }
  });
});

test("a motion that is too slow is drawn more cheaply, and better again when there is time", () => {
  const pace = new Pace(false);
  let now_ms = 0;
  const draw = (ms: number, times: number): void => {
    for (let i = 0; i < times; i++) {
      now_ms += ms;
      pace.drawn(ms, now_ms);
    }
  };
  draw(16, 60);
  expect(pace.step).toBe(BEST);
  draw(60, 12);
  expect(pace.step.fineness).toBeLessThan(1);
  draw(16, 30);
  expect(pace.step).not.toBe(BEST); // it was too slow only just now
  draw(16, 4000);
  expect(pace.step).toBe(BEST);
  draw(2000, 1);
  expect(pace.step).toBe(STEPS.at(-1)); // nobody waits six times for that
});

test("without a graphics card one begins with the cheapest", () => {
  expect(new Pace(true).step).toBe(STEPS.at(-1));
});

test("other pages have at least as long as a picture of who moves took, longer while much comes in, and never a third of a second", () => {
  for (const took_ms of [0, 16, 60, 400, 5000]) {
    const [whole_ms, loading_ms] = [breakAfter(took_ms, true), breakAfter(took_ms, false)];
    expect(whole_ms).toBeGreaterThanOrEqual(Math.min(took_ms, 250));
    expect(loading_ms).toBeGreaterThanOrEqual(whole_ms);
    expect(loading_ms).toBeLessThan(333);
  }
  expect(breakAfter(16, false)).toBeGreaterThan(breakAfter(16, true));
});

test("a span is told along the ground and upwards", () => {
  expect(lengthsOf([])).toBeNull();
  expect(lengthsOf([[0, 0, 0]])).toBeNull();
  expect(
    lengthsOf([
      [1, 1, 5],
      [4, 5, 5 - 12],
    ]),
  ).toEqual({ far_m: 13, level_m: 5, high_m: -12 });
});
