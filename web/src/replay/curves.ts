/** Which curves are drawn of chosen estimators, as tables with one column of times. Pure. */

import type { Course, Curve } from "./review";

export type CurveName = "error" | "innovation" | "heading" | "heading_error" | "sigma";
export const CURVES: readonly CurveName[] = ["error", "innovation", "heading", "heading_error", "sigma"];

/** A course and the number of its colour, from 0. */
export interface Chosen {
  readonly course: Course;
  readonly colour: number;
}

export interface Table {
  /** Times, then the values of each line; undefined where a line says nothing of a time, null where it has a gap. */
  readonly data: readonly (readonly (number | null | undefined)[])[];
  /** Of each line. */
  readonly colours: readonly number[];
  readonly unit: string;
  readonly decimals: number;
}

const OF: Readonly<Record<CurveName, (course: Course) => readonly [readonly number[], Curve]>> = {
  error: (course) => [course.t_s, course.error_m],
  innovation: (course) => [course.innovation_s, course.innovation_m],
  heading: (course) => [course.t_s, course.heading_deg],
  heading_error: (course) => [course.t_s, course.heading_error_deg],
  sigma: (course) => [course.t_s, course.sigma_m],
};
const UNITS: Readonly<Record<CurveName, readonly [string, number]>> = {
  error: ["m", 2],
  innovation: ["m", 2],
  heading: ["°", 1],
  heading_error: ["°", 1],
  sigma: ["m", 2],
};
/** Return the table of a curve; null where none of the chosen has a value of it. */
export function tableOf(name: CurveName, chosen: readonly Chosen[]): Table | null {
  const [unit, decimals] = UNITS[name];
  const parts = chosen.map(({ course, colour }) => ({ curve: OF[name](course), colour }));
  const known = parts.filter(({ curve: [, values] }) => values.some((value) => value !== null));
  if (known.length === 0) return null;
  return { data: joined(known.map(({ curve }) => curve)), colours: known.map(({ colour }) => colour), unit, decimals };
}

/** Return curves of different times over all their times. */
export function joined(
  curves: readonly (readonly [readonly number[], Curve])[],
): readonly (readonly (number | null | undefined)[])[] {
  const times = [...new Set(curves.flatMap(([t_s]) => t_s))].sort((a, b) => a - b);
  const place = new Map(times.map((t_s, index) => [t_s, index]));
  const columns = curves.map(([t_s, values]) => {
    const column: (number | null | undefined)[] = new Array(times.length).fill(undefined);
    t_s.forEach((time, index) => {
      column[place.get(time) ?? 0] = values[index] ?? null;
    });
    return column;
  });
  return [times, ...columns];
}
