// @ts-check
// The parameters of the robot: sliders where a range is known.
import { ask, empty, make } from "./page.js";
import { robot } from "./studio.js";

/** @typedef {{initial: string, value: string, error: string | null, fixed: boolean}} Param */

export class Params {
  /** @param {HTMLElement} place @param {HTMLInputElement} filter */
  constructor(place, filter) {
    this.place = place;
    this.filter = filter;
    /** @type {Map<string, {row: HTMLElement, show: (param: Param) => void}>} */ this.rows = new Map();
    filter.addEventListener("input", () => this.sift());
  }

  begin() {
    this.rows.clear();
    this.place.replaceChildren();
    for (const info of robot.about?.params ?? []) {
      const row = this.row(info);
      this.rows.set(info.name, row);
      this.place.append(row.row);
    }
    const save = document.createElement("button");
    save.id = "params-save";
    save.textContent = "Save changes to a file";
    save.title = "as TOML, for --params";
    save.hidden = robot.readonly || this.rows.size === 0;
    save.addEventListener("click", () => ask("save"));
    this.saved = document.createElement("div");
    this.saved.id = "params-saved";
    this.place.append(save, this.saved);
    if (this.rows.size === 0) this.place.append(empty("no parameters"));
    this.sift();
  }

  /** @param {Record<string, Param>} all */
  update(all) {
    for (const [name, param] of Object.entries(all)) this.rows.get(name)?.show(param);
  }

  /** @param {{Ok?: string, Err?: string}} result */
  tell(result) {
    if (this.saved) this.saved.textContent = result.Ok ? `written to ${result.Ok}` : result.Err ?? "";
  }

  sift() {
    const words = this.filter.value.toLowerCase();
    for (const [name, { row }] of this.rows) row.hidden = !name.toLowerCase().includes(words);
  }

  /** @param {import("./studio.js").ParamInfo} info */
  row(info) {
    const row = make("div", "param");
    row.dataset.param = info.name;
    const [line, error] = [make("div", "row"), make("div", "error")];
    const text = /** @type {HTMLInputElement} */ (make("input", ""));
    text.type = "text";
    text.setAttribute("aria-label", info.name);
    const undo = /** @type {HTMLButtonElement} */ (make("button", "undo", "↺"));
    const write = /** @type {HTMLButtonElement} */ (make("button", "write", "✎"));
    write.title = "write it into the source file";
    write.addEventListener("click", () => ask({ write: info.name }));
    const set = (/** @type {string} */ value) => ask({ set: { name: info.name, value } });
    let initial = "";
    text.addEventListener("change", () => set(text.value));
    undo.addEventListener("click", () => set(initial));
    /** @type {HTMLInputElement | null} */ let slider = null;
    // Where the slider is, until it is sent: meanwhile the robot may tell where it was.
    /** @type {string | null} */ let chosen = null;
    const whole = !/f32|f64/.test(info.ty);
    if (info.min !== null && info.max !== null) {
      slider = /** @type {HTMLInputElement} */ (make("input", ""));
      slider.type = "range";
      slider.min = "0";
      slider.max = whole && info.max - info.min < 1000 ? String(info.max - info.min) : "1000";
      slider.setAttribute("aria-label", info.name);
      slider.addEventListener("input", () => {
        const share = Number(/** @type {HTMLInputElement} */ (slider).value) / Number(slider?.max);
        const exact = fromShare(share, info);
        const value = whole ? Math.round(exact) : exact;
        if (chosen === null) setTimeout(() => { set(chosen ?? ""); chosen = null; }, 50);
        chosen = whole ? String(value) : floating(value);
        text.value = chosen;
      });
      line.append(slider);
    }
    line.append(text, make("span", "unit", info.unit ?? ""), undo, write);
    const range = info.min === null && info.max === null ? info.ty : `${info.ty}, ${info.min ?? ""}..${info.max ?? ""}`;
    row.append(make("div", "name", info.name), line, make("div", "range", range), error);
    for (const input of [text, slider, undo]) if (input) input.disabled = robot.readonly;
    const show = (/** @type {Param} */ param) => {
      initial = param.initial;
      row.classList.toggle("is-fixed", param.fixed);
      row.classList.toggle("is-changed", param.value !== param.initial);
      undo.hidden = param.value === param.initial;
      write.hidden = undo.hidden || robot.readonly;
      undo.title = `back to ${param.initial}`;
      error.textContent = param.error ?? "";
      if (chosen === null && (document.activeElement !== text || param.error === null)) text.value = param.value;
      if (slider && document.activeElement !== slider) slider.value = String(toShare(Number(param.value), info) * Number(slider.max));
    };
    return { row, show };
  }
}

/** A number that TOML takes as one with a fraction. @param {number} value */
function floating(value) {
  const short = String(Number(value.toPrecision(6)));
  return /[.e]/.test(short) ? short : `${short}.0`;
}

/** @typedef {import("./studio.js").ParamInfo} ParamInfo */

/** `true` if a range is so wide that only its logarithm can be handled. @param {ParamInfo} info */
const isWide = ({ min, max }) => min !== null && max !== null && min > 0 && max / min >= 1000;

/** @param {number} value @param {ParamInfo} info */
function toShare(value, info) {
  const { min = 0, max = 1 } = /** @type {any} */ (info);
  return isWide(info) ? Math.log(value / min) / Math.log(max / min) : (value - min) / (max - min);
}

/** @param {number} share @param {ParamInfo} info */
function fromShare(share, info) {
  const { min = 0, max = 1 } = /** @type {any} */ (info);
  return isWide(info) ? min * (max / min) ** share : min + share * (max - min);
}
