/** What the keys do, as a list for the help. DOM only. */

import { type Key, say } from "../language/speech";

const KEYS: readonly (readonly [readonly string[], Key])[] = [
  [["W", "A", "S", "D"], "help.move"],
  [["←", "↑", "↓", "→"], "help.turn"],
  [["⇧"], "help.run"],
  [["E", "Q"], "help.up"],
  [["1", "2", "3"], "help.ways"],
  [["T"], "help.times"],
  [["M"], "help.tape"],
  [["V"], "describe.long"],
];

/** Fill a list of terms with the keys. */
export function fillKeys(list: HTMLElement): void {
  list.replaceChildren(
    ...KEYS.flatMap(([keys, text]) => {
      const [term, meaning] = [document.createElement("dt"), document.createElement("dd")];
      keys.forEach((name, i) => {
        const key = document.createElement("kbd");
        key.textContent = name;
        term.append(i > 0 ? " " : "", key);
      });
      meaning.textContent = say(text as "help.move");
      return [term, meaning];
    }),
  );
}
