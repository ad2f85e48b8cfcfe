/** What the pages say in Turkish: to visitors as "siz", in the words that Turkish museums use. */

import type { Catalogue } from "./catalogue";

export const tr: Catalogue = {
  language: "Dil",
  "language.name": "Türkçe",
};
