// @ts-check
// Names of nodes and graphs, completed while one types a condition.
import { make } from "./page.js";
import { robot } from "./studio.js";

/** Most names in the list. */
const MOST = 12;

/** The nodes that can be active, and the graphs around them. */
function names() {
  const { nodes = [], connections = [] } = robot.about ?? {};
  const ends = connections.filter(({ activity }) => activity).flatMap(({ from, to }) => [from, to]);
  const states = [...new Set(ends)].filter((at) => !["relay", "probe", "start"].includes(nodes[at].kind)).map((at) => nodes[at].name);
  const graphs = states.flatMap((name) => name.split(".").slice(1).map((_, at) => name.split(".").slice(0, at + 1).join(".")));
  return [...new Set([...states, ...graphs])].sort();
}

/** Completes names in a field, by a list below it. @param {HTMLInputElement} field @param {HTMLElement} list */
export function completeNames(field, list) {
  let chosen = 0;
  /** The word before the caret. */
  const word = () => /[\w.]*$/.exec(field.value.slice(0, field.selectionStart ?? 0))?.[0] ?? "";
  const close = () => { list.hidden = true; };

  const choose = (/** @type {number} */ at) => {
    const rows = [...list.children];
    chosen = (at + rows.length) % Math.max(1, rows.length);
    rows.forEach((row, index) => row.setAttribute("aria-selected", String(index === chosen)));
    rows[chosen]?.scrollIntoView({ block: "nearest" });
  };

  const accept = () => {
    const [name, end] = [list.children[chosen]?.textContent ?? "", field.selectionStart ?? 0];
    const start = end - word().length;
    // Only whether a node is active can be asked.
    const isWithin = /active\s*\(\s*$/.test(field.value.slice(0, start));
    // As if it was typed, so that it can be undone, and counts as a change.
    field.setSelectionRange(start, end);
    document.execCommand("insertText", false, isWithin ? name : `active(${name})`);
    close();
  };

  field.addEventListener("input", () => {
    const typed = word().toLowerCase();
    const found = typed === "" ? [] : names().filter((name) => name.toLowerCase().includes(typed)).slice(0, MOST);
    if (found.length === 0 || (found.length === 1 && found[0] === typed)) return close();
    list.replaceChildren(...found.map((name, at) => {
      const row = make("li", "", name);
      row.setAttribute("role", "option");
      row.addEventListener("pointerdown", (event) => {
        event.preventDefault();
        choose(at);
        accept();
      });
      return row;
    }));
    const { left, bottom } = field.getBoundingClientRect();
    Object.assign(list.style, { left: `${left}px`, top: `${bottom + 2}px` });
    list.hidden = false;
    // The first name that begins so.
    choose(Math.max(0, found.findIndex((name) => name.split(".").some((part) => part.toLowerCase().startsWith(typed)))));
  });
  field.addEventListener("keydown", (event) => {
    if (list.hidden) return;
    /** @type {Record<string, () => void>} */
    const keys = { ArrowDown: () => choose(chosen + 1), ArrowUp: () => choose(chosen - 1), Enter: accept, Tab: accept, Escape: close };
    if (!keys[event.key]) return;
    event.preventDefault();
    event.stopPropagation();
    keys[event.key]();
  });
  field.addEventListener("blur", close);
}
