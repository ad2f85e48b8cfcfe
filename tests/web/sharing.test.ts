/** What a page says of who sees the camera's picture. */

import { markOf } from "../../web/src/sharing";

test.each([
  [true, "viewer", /Everybody/],
  [true, "rig", /Everybody/],
  [true, "operator", /Everybody/],
  [false, "viewer", /private/],
  [false, "admin", /private/],
  [false, "rig", /^$/],
  [true, "local", /^$/],
  [false, "local", /^$/],
] as const)("sharing %s, seen by a %s", (sharing, role, said) => {
  expect(markOf(sharing, role)).toMatch(said);
});
