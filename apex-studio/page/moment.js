// @ts-check
// An interval of the timeline that becomes a test.
import { ask, element } from "./page.js";
import { robot, shown } from "./studio.js";

export class Moment {
  /** @param {import("./timeline.js").Timeline} timeline */
  constructor(timeline) {
    this.timeline = timeline;
    element("moment-from").addEventListener("click", () => this.set(timeline.cursor ?? robot.now, null));
    element("moment-to").addEventListener("click", () => this.set(null, timeline.cursor ?? robot.now));
    element("moment-test").addEventListener("click", () => {
      const [from, to] = timeline.marked ?? [0, 0];
      ask({ test: [from, to] });
    });
    timeline.canvas.addEventListener("mark", (event) => {
      const [from, to] = /** @type {CustomEvent} */ (event).detail;
      this.set(from, to);
    });
  }

  begin() {
    this.timeline.marked = null;
    for (const id of ["moment-from", "moment-to"]) element(id).hidden = robot.readonly || !robot.about?.simulated;
    this.show();
  }

  /** Moves the ends of the interval. @param {number | null} from @param {number | null} to */
  set(from, to) {
    const [a, b] = this.timeline.marked ?? [0, robot.now];
    const [first, last] = [from ?? a, to ?? b];
    // Whole milliseconds read better in a test.
    const round = (/** @type {number} */ time) => Math.round(time * 1000) / 1000;
    this.timeline.marked = [round(Math.min(first, last)), round(Math.max(first, last))];
    this.show();
    this.timeline.draw();
  }

  show() {
    const { marked } = this.timeline;
    element("moment-test").hidden = marked === null || robot.readonly;
    element("moment").textContent = marked === null ? "" : `${shown(marked[0])} – ${shown(marked[1])}`;
  }

  /** @param {{Ok?: string, Err?: string}} result */
  tell(result) {
    element("moment").textContent = result.Ok ? `written to ${result.Ok}` : result.Err ?? "";
  }
}
