// @ts-check
// What the pages of `apex studio` have in common: the connection, the header, tips, panels and keys.

/** @param {string} id @returns {any} */
export const element = (id) => document.getElementById(id);

/** @type {WebSocket | null} */
let socket = null;

/** Sends a message to the studio. @param {any} message */
export function ask(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

/** Connects to the studio, again and again. @param {string} place @param {(kind: string, told: any) => void} hear handles a message of a kind @param {() => void} begin asks for what is needed */
export function connect(place, hear, begin) {
  const token = location.hash.slice(1) || sessionStorage.getItem("token") || "";
  sessionStorage.setItem("token", token);
  let refused = false;
  socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/${place}`);
  socket.addEventListener("open", () => {
    socket?.send(token);
    begin();
  });
  socket.addEventListener("message", ({ data }) => {
    for (const [kind, told] of Object.entries(JSON.parse(data))) {
      if (kind === "refused") {
        refused = true;
        state("lost", "wrong token: open the address that `apex studio` has printed");
      } else hear(kind, told);
    }
  });
  socket.addEventListener("close", () => {
    if (refused) return;
    state("lost", "no connection to `apex studio`; trying again");
    setTimeout(() => connect(place, hear, begin), 1000);
  });
}

/** Shows in the header what happens. @param {string} kind @param {string} words */
export function state(kind, words) {
  element("run").className = kind;
  element("run").textContent = words;
}

/** Fills the choice of robots and studies in the header. @param {string[]} robots @param {string[]} studies @param {string} shown */
export function choose(robots, studies, shown) {
  const choice = element("robot");
  choice.hidden = robots.length + studies.length < 2;
  const other = robots.map((name, at) => new Option(name, String(at)));
  choice.replaceChildren(...other, ...studies.map((name, at) => new Option(`study ${name}`, `study?${at}`)));
  choice.value = shown;
}

/** Shows a tip near the pointer. @param {string | null} words @param {MouseEvent} [at] */
export function tip(words, at) {
  const tip = element("tip");
  tip.hidden = !words;
  if (!words || !at) return;
  tip.textContent = words;
  const { width, height } = tip.getBoundingClientRect();
  tip.style.left = `${Math.max(0, Math.min(at.clientX + 14, innerWidth - width - 8))}px`;
  tip.style.top = `${Math.max(0, Math.min(at.clientY + 14, innerHeight - height - 8))}px`;
}

/** @param {string} words */
export function empty(words) {
  const item = document.createElement("li");
  item.className = "empty";
  item.textContent = words;
  return item;
}

/** @param {string} kind @param {string} name @param {string} words */
export function make(kind, name, words = "") {
  const made = document.createElement(kind);
  made.className = name;
  made.textContent = words;
  return made;
}

/** Shows one of the panels. @param {string} name */
export function panel(name) {
  for (const tab of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-tab]"))) {
    tab.setAttribute("aria-selected", String(tab.dataset.tab === name));
    // One of them is reached by Tab, the others from there by the arrow keys.
    tab.tabIndex = tab.dataset.tab === name ? 0 : -1;
  }
  for (const panel of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-panel]"))) {
    panel.hidden = panel.dataset.panel !== name;
  }
}

/** Lets the tabs be reached by the arrow keys, and the keys be shown. Returns the tabs. */
export function listen() {
  const tabs = /** @type {HTMLElement[]} */ ([...document.querySelectorAll("[data-tab]")]);
  document.querySelector("nav")?.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const at = tabs.indexOf(/** @type {HTMLElement} */ (event.target));
    if (step === undefined || at < 0) return;
    const next = tabs[(at + step + tabs.length) % tabs.length];
    next.click();
    next.focus();
  });
  element("help").addEventListener("click", () => element("keys").showModal());
  element("keys").addEventListener("click", () => element("keys").close());
  // After a choice, keys are those of the page again.
  document.addEventListener("change", ({ target }) => target instanceof HTMLSelectElement && target.blur());
  addEventListener("hashchange", () => location.reload());
  return tabs;
}

/** `true` for a key that belongs to a field, or to the browser. @param {KeyboardEvent} event */
export function isTyping(event) {
  const target = /** @type {HTMLElement} */ (event.target);
  // Space halts the robot, whatever was clicked before: names that one looks for have no spaces.
  if (event.key === " " && target.matches("button, [type=checkbox], [type=range], [type=search], [readonly]")) return false;
  if (!target.matches("input, select, textarea") && !event.ctrlKey && !event.metaKey && !event.altKey) return false;
  // What was typed counts; the next key is one of the page again.
  if (event.key === "Escape" || (event.key === "Enter" && target.matches("input"))) target.blur();
  return true;
}

/** Does what a key stands for; digits show the panels. @param {KeyboardEvent} event @param {Record<string, () => void>} keys @param {HTMLElement[]} tabs */
export function press(event, keys, tabs) {
  if (element("keys").open && event.key !== " ") return;
  const act = keys[event.key] ?? tabs[Number(event.key) - 1]?.click.bind(tabs[Number(event.key) - 1]);
  if (act) {
    event.preventDefault();
    act();
  }
}

/** Colours of the page, by name: each is computed once for a drawing. */
export function colors() {
  const style = getComputedStyle(document.documentElement);
  /** @type {Map<string, string>} */
  const known = new Map();
  return (/** @type {string} */ name) => {
    const color = known.get(name) ?? style.getPropertyValue(name);
    known.set(name, color);
    return color;
  };
}

/** Gives a canvas a size, and clears it. @param {HTMLCanvasElement} canvas @param {number} width @param {number} height */
export function cleared(canvas, width, height) {
  const [w, h] = [Math.round(width * devicePixelRatio), Math.round(height * devicePixelRatio)];
  // A new size costs a new canvas, also if it is the same one.
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
    canvas.style.height = `${height}px`;
  }
  const c = canvas.getContext("2d");
  if (!c) return null;
  c.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  c.clearRect(0, 0, width, height);
  c.font = "12px system-ui, sans-serif";
  c.textBaseline = "middle";
  return c;
}

/** Round numbers in a range, about as many as are wanted, and their number of decimal places. @param {number} low @param {number} high @param {number} count @returns {[number[], number]} */
export function marks(low, high, count) {
  const rough = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough) ?? power;
  const first = Math.ceil(low / step - 1e-9);
  const all = Array.from({ length: Math.max(0, Math.floor(high / step + 1e-9) - first + 1) }, (_, at) => (first + at) * step);
  return [all, Math.max(0, -Math.floor(Math.log10(step)))];
}
