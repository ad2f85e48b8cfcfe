/** The sun: the same as Python's, its vector, its hours and the colours of its light. */

import { readFileSync } from "node:fs";
import { angleBetween, atSolarHour, daylight, directionOf, sunAt } from "../../web/src/sun";

interface Case {
  readonly t_unix_s: number;
  readonly lat_deg: number;
  readonly lon_deg: number;
  readonly now_deg: readonly [number, number];
  readonly then_deg: readonly [number, number];
}

const golden = JSON.parse(readFileSync(new URL("../golden/sun.json", import.meta.url), "utf8")) as {
  readonly year: number;
  readonly cases: readonly Case[];
};
const degrees = (rad: number): number => (rad * 180) / Math.PI;
const radians = (deg: number): number => (deg * Math.PI) / 180;

test("the sun stands where Python has it, today and in antiquity", () => {
  expect(golden.cases.length).toBeGreaterThan(5);
  for (const { t_unix_s, lat_deg, lon_deg, now_deg, then_deg } of golden.cases) {
    for (const [year, expected] of [
      [null, now_deg],
      [golden.year, then_deg],
    ] as const) {
      const { azimuth_rad, elevation_rad } = sunAt(t_unix_s, lat_deg, lon_deg, year);
      expect(degrees(azimuth_rad)).toBeCloseTo(expected[0], 5);
      expect(degrees(elevation_rad)).toBeCloseTo(expected[1], 5);
    }
  }
});

test("its vector is east, north, up", () => {
  const [east, north, up] = directionOf({ azimuth_rad: radians(90), elevation_rad: radians(30) });
  expect(east).toBeCloseTo(Math.cos(radians(30)), 12);
  expect(north).toBeCloseTo(0, 12);
  expect(up).toBeCloseTo(0.5, 12);
  const noon = { azimuth_rad: 3, elevation_rad: 1 };
  expect(angleBetween(noon, { azimuth_rad: 3, elevation_rad: 1.25 })).toBeCloseTo(0.25, 9);
});

test("a solar hour is at most half a day away", () => {
  const t = Date.UTC(2026, 5, 21, 8) / 1000;
  for (const hour of [0, 6.5, 12, 18, 23.9]) {
    const found = atSolarHour(t, 27.3447, hour);
    expect(Math.abs(found - t)).toBeLessThanOrEqual(12 * 3600);
    expect((((found / 3600 + 27.3447 / 15 - hour) % 24) + 24.0001) % 24).toBeLessThan(0.001);
  }
  const { azimuth_rad } = sunAt(atSolarHour(t, 27.3447, 12), 37.9366, 27.3447);
  expect(degrees(azimuth_rad)).toBeGreaterThan(175);
  expect(degrees(azimuth_rad)).toBeLessThan(185);
});

test("a low sun is redder and weaker, and after it has set the sky is left", () => {
  const heights = [60, 30, 10, 4, 1].map((height) => daylight(radians(height)));
  for (const [i, light] of heights.slice(1).entries()) {
    const higher = heights[i];
    expect(light.sunStrength).toBeLessThan(higher?.sunStrength ?? 0);
    expect(light.sunColour[2] / light.sunColour[0]).toBeLessThan(
      (higher?.sunColour[2] ?? 0) / (higher?.sunColour[0] ?? 1),
    );
  }
  expect(daylight(radians(62)).sunStrength).toBeCloseTo(2.6, 9);
  const night = daylight(radians(-20));
  expect(night.sunStrength).toBe(0);
  expect(night.skyStrength).toBeGreaterThan(0);
  expect(night.skyStrength).toBeLessThan(daylight(radians(-1)).skyStrength);
  for (let height = -90; height <= 90; height++)
    for (const value of Object.values(daylight(radians(height))).flat() as number[]) {
      expect(value).toBeGreaterThanOrEqual(0);
      expect(value).toBeLessThan(3.1);
    }
});
