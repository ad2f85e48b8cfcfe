/** Which keys belong to the control that has the focus, and not to the page. DOM only. */

/** What a slider takes. */
const SLIDES = /^(Arrow|Page|Home$|End$)/;

/** Whether a key that is pressed there is for a field, a menu or a slider of the page. */
export function isTaken({ target, code, ctrlKey, metaKey, altKey }: KeyboardEvent): boolean {
  if (ctrlKey || metaKey || altKey) return true;
  if (target instanceof HTMLInputElement)
    return target.type === "range" ? SLIDES.test(code) : target.type !== "checkbox";
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}
