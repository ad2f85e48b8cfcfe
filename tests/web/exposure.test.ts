/** Brightness and cast of a picture, and how the model follows them. */

import { gainFor, Matching, meanLight } from "../../web/src/exposure";

function picture(r: number, g: number, b: number): Uint8ClampedArray {
  return new Uint8ClampedArray(Array.from({ length: 12 }, () => [r, g, b, 255]).flat());
}

test("the mean is of light, not of bytes", () => {
  const [r, g, b] = meanLight(picture(255, 188, 0));
  expect(r).toBeCloseTo(1, 9);
  expect(g).toBeCloseTo(0.503, 2);
  expect(b).toBe(0);
  expect(meanLight(new Uint8ClampedArray())).toEqual([0, 0, 0]);
});

test("a darker picture asks for a darker model, a blue one for a bluer", () => {
  const usual = gainFor([0.3, 0.3, 0.3]);
  for (const factor of usual) expect(factor).toBeCloseTo(1, 9);
  for (const factor of gainFor([0.15, 0.15, 0.15])) expect(factor).toBeCloseTo(0.5, 9);
  const [r, , b] = gainFor([0.25, 0.3, 0.4]);
  expect(b).toBeGreaterThan(1.1 * r);
  for (const light of [0, 1e-9, 1])
    for (const factor of gainFor([light, light, light])) {
      expect(factor).toBeGreaterThanOrEqual(0.19);
      expect(factor).toBeLessThanOrEqual(2.01);
    }
});

test("a camera that has opened up in the evening leaves the model as bright as its picture", () => {
  const [noon] = gainFor([0.3, 0.3, 0.3], 1);
  const [evening] = gainFor([0.3, 0.3, 0.3], 0.6);
  expect(evening * 0.6).toBeCloseTo(noon, 9);
});

test("the first picture is obeyed at once, a change nearly in a second, and nothing flickers", () => {
  const matching = new Matching();
  expect(matching.take([0.5, 0.5, 0.5], 1000)).toEqual([0.5, 0.5, 0.5]);
  const [after] = matching.take([1, 1, 1], 1040);
  expect(after).toBeLessThan(0.56);
  let gain = after;
  for (let ms = 1080; ms <= 2040; ms += 40) {
    const [next] = matching.take([1, 1, 1], ms);
    expect(next).toBeGreaterThanOrEqual(gain);
    gain = next;
  }
  expect(gain).toBeGreaterThan(0.95);
  expect(gain).toBeLessThanOrEqual(1);
});
