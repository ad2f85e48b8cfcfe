/**
 * Where the sun stands at a date and an hour, today and in antiquity, and the colours of its light. Pure.
 *
 * The twin of `assets/solar.py`, which says what is left out; `tests/golden/sun.json` holds both to each other.
 * Reference: Jean Meeus, Astronomical Algorithms, 2nd edition, 1998, chapters 12, 13, 16, 22 and 25.
 */

import type { Vector3 } from "./frames";

export interface Sun {
  /** Clockwise from true north. */
  readonly azimuth_rad: number;
  readonly elevation_rad: number;
}

/** The year that the model shows. */
export const ANCIENT_YEAR = 150;
/** 2000-01-01 12:00 UTC. */
const UNIX_J2000_S = 946_728_000;
const CENTURY_S = 36_525 * 86_400;
const { sin, cos, tan, asin, atan2, PI } = Math;

/**
 * Return the sun as it is seen at a time (seconds since 1970) and a place.
 *
 * `year`: at the same season and true solar time under the sky of that year; null for the time's own.
 */
export function sunAt(t_unix_s: number, lat_deg: number, lon_deg: number, year: number | null = null): Sun {
  const centuries = (t_unix_s - UNIX_J2000_S) / CENTURY_S;
  const longitude = longitudeOf(centuries);
  const obliquity = obliquityOf(centuries);
  const ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude));
  const hourAngle = radians(siderealOf(t_unix_s) + lon_deg) - ascension;
  const tilt = year === null ? obliquity : obliquityOf((year - 2000) / 100);
  const declination = asin(sin(tilt) * sin(longitude));
  const lat = radians(lat_deg);
  const azimuth = atan2(sin(hourAngle), cos(hourAngle) * sin(lat) - tan(declination) * cos(lat)) + PI;
  const elevation = asin(sin(lat) * sin(declination) + cos(lat) * cos(declination) * cos(hourAngle));
  return { azimuth_rad: azimuth % (2 * PI), elevation_rad: elevation + refractionOf(elevation) };
}

/** Return the unit vector towards the sun, site frame. */
export function directionOf({ azimuth_rad, elevation_rad }: Sun): Vector3 {
  const flat = cos(elevation_rad);
  return [flat * sin(azimuth_rad), flat * cos(azimuth_rad), sin(elevation_rad)];
}

/** Return the angle between two places of the sun, radians. */
export function angleBetween(a: Sun, b: Sun): number {
  const [u, v] = [directionOf(a), directionOf(b)];
  return 2 * asin(Math.min(1, Math.hypot(u[0] - v[0], u[1] - v[1], u[2] - v[2]) / 2));
}

/** Return the time nearest to `t_unix_s` at which the mean sun has that hour there: 12 when it is highest, or nearly. */
export function atSolarHour(t_unix_s: number, lon_deg: number, hour: number): number {
  const now = (((t_unix_s / 3600 + lon_deg / 15) % 24) + 24) % 24;
  const ahead = (((hour - now) % 24) + 36) % 24;
  return t_unix_s + (ahead - 12) * 3600;
}

/** The light of a sun and its sky: colours are linear red, green and blue, at most 1. */
export interface Daylight {
  readonly sunColour: Vector3;
  readonly sunStrength: number;
  readonly skyColour: Vector3;
  readonly skyStrength: number;
}

/** Of each colour: what one thickness of the air takes from the direct light (clear air by the sea, AOD about 0.15). */
const DIMMING: Vector3 = [0.16, 0.23, 0.36];
/** Of light that has come through the air at 62 degrees, which is the light that the model's colours were chosen in. */
const USUAL_RAD = radians(62);
const USUAL_STRENGTH = 2.6;
/** How high the sun is when the last direct light goes: its disc is half a degree wide. */
const SET_RAD = radians(-0.3);
const RISEN_RAD = radians(1.2);

/** Return the light of a clear day with the sun at this height; after sunset the sky alone gives a little. */
export function daylight(elevation_rad: number): Daylight {
  const through = transmitted(elevation_rad);
  const usual = transmitted(USUAL_RAD);
  const direct = through.map((value, i) => value / (usual[i] ?? 1)) as unknown as Vector3;
  const most = Math.max(...direct);
  const up = smooth((elevation_rad - SET_RAD) / (RISEN_RAD - SET_RAD));
  const dusk = smooth((elevation_rad + radians(9)) / radians(15));
  const high = Math.max(0, sin(elevation_rad));
  const warm = up * (1 - smooth(elevation_rad / radians(25)));
  return {
    sunColour: direct.map((value, i) => (value / most) * (WHITE_SUN[i] ?? 1)) as unknown as Vector3,
    sunStrength: USUAL_STRENGTH * most * up,
    skyColour: [0.62 + 0.3 * warm, 0.77 - 0.02 * warm, 1 - 0.3 * warm],
    skyStrength: 0.06 + dusk * (0.4 + 0.78 * high ** 0.5),
  };
}

/** The sun's colour at its usual height: a little warmer than white. */
const WHITE_SUN: Vector3 = [1, 0.88, 0.716];

/** Return the share of red, green and blue that comes through the air. Reference: Kasten and Young 1989 for the air's thickness. */
function transmitted(elevation_rad: number): Vector3 {
  const h = Math.max(0, (elevation_rad * 180) / PI);
  const thickness = 1 / (sin(radians(h)) + 0.50572 * (h + 6.07995) ** -1.6364);
  return DIMMING.map((depth) => Math.exp(-depth * thickness)) as unknown as Vector3;
}

function smooth(x: number): number {
  const t = Math.min(1, Math.max(0, x));
  return t * t * (3 - 2 * t);
}

function longitudeOf(t: number): number {
  const mean = 280.46646 + 36_000.76983 * t + 0.0003032 * t * t;
  const anomaly = radians(357.52911 + 35_999.05029 * t - 0.0001537 * t * t);
  const centre =
    (1.914602 - 0.004817 * t - 0.000014 * t * t) * sin(anomaly) +
    (0.019993 - 0.000101 * t) * sin(2 * anomaly) +
    0.000289 * sin(3 * anomaly);
  return radians(mean + centre - 0.00569 - 0.00478 * sin(nodeOf(t)));
}

function obliquityOf(t: number): number {
  const mean = 23.4392911 - 0.0130041667 * t - 1.64e-7 * t * t + 5.036e-7 * t * t * t;
  return radians(mean + 0.00256 * cos(nodeOf(t)));
}

function nodeOf(t: number): number {
  return radians(125.04 - 1934.136 * t);
}

function siderealOf(t_unix_s: number): number {
  return (280.46061837 + (360.98564736629 * (t_unix_s - UNIX_J2000_S)) / 86_400) % 360;
}

function refractionOf(elevation_rad: number): number {
  const h = (elevation_rad * 180) / PI;
  return h > -1 ? radians(1.02 / tan(radians(h + 10.3 / (h + 5.11))) / 60) : 0;
}

function radians(degrees: number): number {
  return (degrees * PI) / 180;
}
