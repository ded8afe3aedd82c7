//! A real browser, over the DevTools protocol.

use crate::steady::Steady;
use base64::{Engine as _, prelude::BASE64_STANDARD};
use serde_json::{Value, json};
use std::{
    env, fs,
    io::{BufRead as _, BufReader},
    net::TcpStream,
    path::PathBuf,
    process::{Child, Command, Stdio},
    sync::{Arc, Mutex, PoisonError, Weak},
    thread,
    time::{Duration, Instant},
};
use tungstenite::{Message, WebSocket, client};

/// Time that a page has to show something. On a busy machine, one that takes nothing for ten seconds loses its
/// connection, and begins again.
const PATIENCE: Duration = Duration::from_secs(60);
/// The control key, as a modifier of events.
const CONTROL: u32 = 2;

/// The program of the browser, for all tests that run at the same time.
struct Program {
    process: Child,
    profile: PathBuf,
    /// Address at which it speaks the protocol.
    address: String,
}

/// A browser with one page, which shares nothing with those of other tests.
pub struct Browser {
    _program: Arc<Program>,
    socket: WebSocket<Steady>,
    session: String,
    count: u64,
    /// Errors and messages of the page.
    pub complaints: Vec<String>,
}

impl Program {
    /// The program that runs, or a new one. It ends with its last page.
    fn shared() -> Option<Arc<Self>> {
        static LAST: Mutex<Weak<Program>> = Mutex::new(Weak::new());
        let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
        let program = last.upgrade().or_else(|| Self::start().map(Arc::new))?;
        *last = Arc::downgrade(&program);
        Some(program)
    }

    fn start() -> Option<Self> {
        let program = ["chromium", "chromium-browser", "google-chrome"].into_iter().find(|name| is_there(name))?;
        let profile = tempfile();
        // The last draws in space without the hardware for it.
        let options = [
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--remote-debugging-port=0",
            "--enable-unsafe-swiftshader",
        ];
        let mut command = Command::new(program);
        command.args(options).arg(format!("--user-data-dir={}", profile.display())).arg("about:blank");
        let mut process = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the browser starts");
        let mut lines = BufReader::new(process.stderr.take().expect("it is piped")).lines();
        let address = lines
            .find_map(|line| Some(line.ok()?.strip_prefix("DevTools listening on ")?.to_owned()))
            .expect("the browser tells its address");
        // The browser must not wait for a reader of its messages.
        thread::spawn(move || lines.for_each(drop));
        Some(Self { process, profile, address })
    }

    /// A new connection to it.
    fn connect(&self) -> WebSocket<Steady> {
        let host = self.address.strip_prefix("ws://").and_then(|rest| rest.split('/').next()).expect("an address");
        let stream = TcpStream::connect(host).expect("the browser listens");
        client(&self.address, Steady(stream)).expect("the browser answers").0
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = fs::remove_dir_all(&self.profile);
    }
}

impl Browser {
    /// Opens a page. Returns `None` with a message without a browser; in CI this is a failure.
    pub fn open(url: &str) -> Option<Self> {
        let Some(program) = Program::shared() else {
            assert!(env::var_os("CI").is_none(), "there is no Chromium");
            println!("skipped: there is no Chromium; `apt install chromium`");
            return None;
        };
        let socket = program.connect();
        let mut browser = Self { _program: program, socket, session: String::new(), count: 0, complaints: vec![] };
        let context = browser.call("Target.createBrowserContext", json!({ "disposeOnDetach": true }));
        let page = json!({ "url": "about:blank", "browserContextId": context["browserContextId"], "newWindow": true });
        let target = browser.call("Target.createTarget", page);
        let attached = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attached);
        browser.session = session["sessionId"].as_str().expect("a session").to_owned();
        for domain in ["Runtime", "Log", "Page"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        browser.call("Page.navigate", json!({ "url": url }));
        browser.wait_for("document.readyState === 'complete' && document.getElementById('run')");
        Some(browser)
    }

    fn call(&mut self, method: &str, params: Value) -> Value {
        self.count += 1;
        let mut message = json!({ "id": self.count, "method": method, "params": params });
        if !self.session.is_empty() {
            message["sessionId"] = self.session.clone().into();
        }
        self.socket.send(Message::Text(message.to_string().into())).expect("the browser listens");
        loop {
            let Message::Text(text) = self.socket.read().expect("the browser answers") else { continue };
            let mut answer: Value = serde_json::from_str(&text).expect("JSON");
            match answer["method"].as_str() {
                // What draws in space without hardware complains of itself.
                Some("Log.entryAdded") if text.contains("GL Driver Message") => {}
                Some("Runtime.exceptionThrown" | "Log.entryAdded" | "Page.javascriptDialogOpening") => {
                    self.complaints.push(text.to_string());
                }
                _ if answer["id"] == self.count => return answer["result"].take(),
                _ => {}
            }
        }
    }

    /// Value of an expression in the page.
    pub fn value(&mut self, expression: &str) -> Value {
        let params = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let mut result = self.call("Runtime.evaluate", params);
        assert!(result["exceptionDetails"].is_null(), "{expression}: {}", result["exceptionDetails"]);
        result["result"]["value"].take()
    }

    /// Waits until an expression is true.
    pub fn wait_for(&mut self, expression: &str) {
        let is_true = self.is_soon(expression, PATIENCE);
        assert!(is_true, "still not: {expression}\n{}\n{:?}", self.words(), self.complaints);
    }

    /// Waits for a time at most until an expression is true. Returns whether it is.
    pub fn is_soon(&mut self, expression: &str, patience: Duration) -> bool {
        let start = Instant::now();
        // While the page loads, there is nothing to look at.
        let tried = format!("(() => {{ try {{ return Boolean({expression}) }} catch {{ return false }} }})()");
        while self.value(&tried) != json!(true) {
            if start.elapsed() > patience {
                return false;
            }
            thread::sleep(Duration::from_millis(30));
        }
        true
    }

    /// All words on the page.
    pub fn words(&mut self) -> String {
        self.value("document.body.innerText").as_str().unwrap_or_default().to_owned()
    }

    /// Sets the size of the page and its theme.
    pub fn size(&mut self, width: u32, height: u32, is_dark: bool) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", size);
        let theme = json!({ "name": "prefers-color-scheme", "value": if is_dark { "dark" } else { "light" } });
        self.call("Emulation.setEmulatedMedia", json!({ "features": [theme] }));
    }

    /// A picture of the page, as PNG.
    pub fn picture(&mut self) -> Vec<u8> {
        let answer = self.call("Page.captureScreenshot", json!({}));
        BASE64_STANDARD.decode(answer["data"].as_str().unwrap_or_default()).expect("base 64")
    }

    /// Presses a key, also with `Control+` before it.
    pub fn press(&mut self, key: &str) {
        let (key, control) = key.strip_prefix("Control+").map_or((key, false), |key| (key, true));
        let text = match key {
            "Enter" => "\r",
            _ if key.chars().count() == 1 && !control => key,
            _ => "",
        };
        let code = match key {
            _ if key.len() > 1 && !matches!(key, "Enter" | "End" | "Home" | "ArrowUp" | "ArrowDown" | "Delete") => 0,
            "Enter" => 13,
            " " => 32,
            "End" => 35,
            "Home" => 36,
            "ArrowUp" => 38,
            "ArrowDown" => 40,
            "Delete" => 46,
            _ => key.to_ascii_uppercase().bytes().next().filter(u8::is_ascii_alphanumeric).map_or(0, u32::from),
        };
        for kind in ["keyDown", "keyUp"] {
            let modifiers = if control { CONTROL } else { 0 };
            let key = json!({ "type": kind, "key": key, "text": text, "modifiers": modifiers, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", key);
        }
    }

    /// Types words, key by key.
    pub fn type_in(&mut self, words: &str) {
        for letter in words.chars() {
            self.press(if letter == '\n' { "Enter".to_owned() } else { letter.to_string() }.as_str());
        }
    }

    /// Replaces the contents of a field.
    pub fn fill(&mut self, field: &str, words: &str) {
        self.click(field);
        self.press("Control+a");
        self.press("Delete");
        self.type_in(words);
        self.press("Enter");
    }

    /// Chooses the option of a list for which an expression about `option` is true, by the keyboard.
    pub fn choose(&mut self, list: &str, option: &str) {
        let found = format!("[...{list}.options].findIndex((option) => {option})");
        self.wait_for(&format!("{found} >= 0"));
        let at = self.value(&found).as_u64().expect("a number");
        self.value(&format!("{list}.focus()"));
        // The list opens, and what is chosen counts at the end.
        self.press(" ");
        self.press("Home");
        (0..at).for_each(|_| self.press("ArrowDown"));
        self.press("Enter");
    }

    fn mouse(&mut self, kind: &str, (x, y): (f64, f64), clicks: u32, modifiers: u32) {
        let (button, buttons) = if clicks > 0 { ("left", u32::from(kind != "mouseReleased")) } else { ("none", 0) };
        let event = json!({
            "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": clicks,
            "modifiers": modifiers, "pointerType": "mouse",
        });
        self.call("Input.dispatchMouseEvent", event);
    }

    /// The place of an element on the screen: its middle, where nothing must lie over it.
    pub fn place(&mut self, element: &str) -> (f64, f64) {
        let hidden = self.value(&format!("{element}.closest('[data-panel][hidden]')?.dataset.panel ?? null"));
        if let Some(panel) = hidden.as_str() {
            self.click(&format!("document.querySelector('[data-tab={panel}]')"));
        }
        let place = self.value(&format!(
            "(() => {{ const found = {element}; found.scrollIntoView({{ block: 'nearest', inline: 'nearest' }});
                const box = found.getBoundingClientRect();
                const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
                const above = document.elementFromPoint(x, y);
                const is_free = above && (found.contains(above) || above.contains(found));
                return is_free ? [x, y] : `${{above?.outerHTML.slice(0, 200)}} lies over it at ${{x}} ${{y}}`; }})()"
        ));
        let (Some(x), Some(y)) = (place[0].as_f64(), place[1].as_f64()) else { panic!("{element}: {place}") };
        (x, y)
    }

    /// Moves the mouse to a place, in pixels.
    pub fn point_at(&mut self, place: (f64, f64)) {
        self.mouse("mouseMoved", place, 0, 0);
    }

    /// Clicks the middle of an element.
    pub fn click(&mut self, element: &str) {
        let place = self.place(element);
        self.click_at(place);
    }

    /// Clicks a place, in pixels.
    pub fn click_at(&mut self, place: (f64, f64)) {
        self.point_at(place);
        self.mouse("mousePressed", place, 1, 0);
        self.mouse("mouseReleased", place, 1, 0);
    }

    /// Clicks the middle of an element twice.
    pub fn double_click(&mut self, element: &str) {
        let place = self.place(element);
        self.click_at(place);
        self.mouse("mousePressed", place, 2, 0);
        self.mouse("mouseReleased", place, 2, 0);
    }

    /// Turns the wheel over the middle of an element, by some pixels towards the user.
    pub fn wheel(&mut self, element: &str, by: f64) {
        let (x, y) = self.place(element);
        self.call(
            "Input.dispatchMouseEvent",
            json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": by }),
        );
    }

    /// Draws the mouse from one place to another, in pixels.
    pub fn drag(&mut self, from: (f64, f64), to: (f64, f64), with_control: bool) {
        let modifiers = if with_control { CONTROL } else { 0 };
        self.mouse("mouseMoved", from, 0, modifiers);
        self.mouse("mousePressed", from, 1, modifiers);
        for share in [0.3, 0.7, 1.0] {
            let between = |a: f64, b: f64| a + share * (b - a);
            self.mouse("mouseMoved", (between(from.0, to.0), between(from.1, to.1)), 1, modifiers);
        }
        self.mouse("mouseReleased", to, 1, modifiers);
    }

    /// Presses the mouse at the first point, moves it over all others, and releases it at the last one. The robot has
    /// time to answer each move.
    pub fn drag_over(&mut self, points: &[(f64, f64)], pause: Duration) {
        let [first, .., last] = points else { return };
        self.mouse("mousePressed", *first, 1, 0);
        for point in points {
            self.mouse("mouseMoved", *point, 1, 0);
            thread::sleep(pause);
        }
        self.mouse("mouseReleased", *last, 1, 0);
    }
}

fn is_there(program: &str) -> bool {
    Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}

fn tempfile() -> PathBuf {
    use std::sync::atomic::{AtomicU32, Ordering};
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    env::temp_dir().join(format!("apex-browser-{}-{number}", std::process::id()))
}
