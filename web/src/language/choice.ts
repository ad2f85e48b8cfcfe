/** Which of the languages that there are a visitor gets. Pure. */

/** Return the first that is wished and there: asked for in the address, chosen before, the browser's; else English. */
export function chosenOf(
  there: readonly string[],
  asked: string | null,
  stored: string | null,
  browser: readonly string[],
): string {
  const wishes = [asked, stored, ...browser].flatMap((wish) => (wish ? [wish.slice(0, 2).toLowerCase()] : []));
  return wishes.find((wish) => there.includes(wish)) ?? "en";
}
