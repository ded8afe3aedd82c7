// @ts-check
// Why a node is active and fired, or why not: asked for the selected node, at the cursor of the timeline or now.
import { ask, empty } from "./page.js";
import { robot, show } from "./studio.js";

/** @typedef {{depth: number, text: string, node: number, at: number}} Line */

export class Why {
  /**
   * @param {HTMLElement} place
   * @param {import("./picture.js").Picture} picture
   * @param {import("./timeline.js").Timeline} timeline
   */
  constructor(place, picture, timeline) {
    this.place = place;
    this.picture = picture;
    this.timeline = timeline;
  }

  /** Forgets the last answer. */
  begin() {
    this.place.replaceChildren(empty("select a node, and press w"));
    this.picture.light([]);
  }

  /** Asks about the selected node, and shows the panel. */
  ask() {
    show("why");
    const node = robot.about?.nodes.findIndex(({ name }) => name === robot.selected) ?? -1;
    if (node >= 0) ask({ why: { node, at: this.timeline.cursor } });
    else this.begin();
  }

  /** Shows an answer. @param {Line[]} lines */
  update(lines) {
    this.place.replaceChildren(...lines.map((line) => this.row(line)));
    if (lines.length === 0) this.place.append(empty("nothing is known about it"));
    this.picture.light(lines.map(({ node }) => node));
  }

  /** @param {Line} line */
  row({ depth, text, node, at }) {
    const [item, button] = ["li", "button"].map((kind) => document.createElement(kind));
    item.style.paddingInlineStart = `${depth}em`;
    button.textContent = text;
    button.addEventListener("click", () => {
      this.picture.jump(robot.about?.nodes[node].name ?? "");
      this.timeline.look(at);
    });
    item.append(button);
    return item;
  }
}
