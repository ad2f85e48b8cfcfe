/** The ways of moving through the square. Pure. */

export type Way = "orbit" | "walk" | "fly";
export const WAYS: readonly Way[] = ["orbit", "walk", "fly"];
