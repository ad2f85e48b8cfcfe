/** Which theme a page shows. */

import { themeOf } from "../../web/src/theme";

test.each([
  [null, null, false, "plain"],
  [null, null, true, "glare"],
  [null, "plain", true, "plain"],
  [null, "glare", false, "glare"],
  ["glare", "plain", false, "glare"],
  ["plain", "glare", true, "plain"],
  ["pink", null, true, "glare"],
  ["pink", "glare", false, "glare"],
] as const)("asked %s, chosen %s, contrast %s: %s", (asked, chosen, contrast, theme) => {
  expect(themeOf(asked, chosen, contrast)).toBe(theme);
});
