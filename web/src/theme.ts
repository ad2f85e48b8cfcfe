/** Which theme is shown: the usual one, or glare, black on white for a screen in the sun. Pure. */

export type Theme = "plain" | "glare";

/** Return the theme that the address asks for, else the one that was chosen before, else what the browser's wish for contrast calls for. */
export function themeOf(asked: string | null, chosen: string | null, wantsContrast: boolean): Theme {
  const wish = [asked, chosen].find((theme) => theme === "glare" || theme === "plain");
  if (wish === "glare" || wish === "plain") return wish;
  return wantsContrast ? "glare" : "plain";
}
