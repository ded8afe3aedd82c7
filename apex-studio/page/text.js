// @ts-check
// The source files: a click on a line selects its node.
import { robot, select } from "./studio.js";

export class Text {
  /** @param {HTMLElement} place */
  constructor(place) {
    this.place = place;
    /** @type {Map<string, HTMLElement>} */ this.rows = new Map();
  }

  /** @param {string[]} texts */
  begin(texts) {
    this.rows.clear();
    this.place.replaceChildren();
    texts.forEach((text, file) => {
      const title = document.createElement("h2");
      title.textContent = robot.about?.files[file] ?? "";
      this.place.append(title, ...text.split("\n").map((line, at) => this.row(line, file, at + 1)));
    });
  }

  /** @param {string} line @param {number} file @param {number} number */
  row(line, file, number) {
    const [row, label] = [document.createElement("span"), document.createElement("span")];
    row.className = "row";
    label.className = "number";
    label.textContent = `${number} `;
    row.append(label, `${line}\n`);
    const nodes = robot.about?.nodes.filter((node) => node.file === file && node.line === number) ?? [];
    if (nodes.length > 0) {
      row.classList.add("has-node");
      row.addEventListener("click", () => select(nodes[0].name));
      for (const node of nodes) this.rows.set(node.name, row);
    }
    return row;
  }

  /** @param {string | null} name */
  select(name) {
    this.place.querySelector(".is-selected")?.classList.remove("is-selected");
    const row = this.rows.get(name ?? "");
    row?.classList.add("is-selected");
    row?.scrollIntoView({ block: "center" });
  }
}
