//! The web server: pages, and sockets for what they ask and are told.

use crate::{
    connections::{self, PATIENCE},
    foxglove,
    messages::{Asked, Told},
    robot::Shared,
    session::{Beside, Session},
    site::Site,
    source::Source,
    study::{self, Followed},
    worker::Worker,
};
use axum::{
    Router,
    extract::{
        Path, State, WebSocketUpgrade,
        ws::{Message, WebSocket},
    },
    http::{HeaderMap, StatusCode, header},
    response::{IntoResponse, Response},
    routing::get,
};
use serde::Serialize;
use std::{sync::Arc, time::Duration};
use tokio::{net::TcpListener, task, time};

/// Interval at which a page gets news.
const TICK: Duration = Duration::from_millis(50);
/// Maximum size of a message of a page in bytes.
const MAX_MESSAGE: usize = 1 << 20;

/// Nothing but this page and its socket: no scripts in names or documentation, no other sites.
const POLICY: &str = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Everything that a page needs.
#[derive(Clone)]
pub struct Serving {
    pub robots: Arc<[Served]>,
    pub studies: Arc<[Arc<Followed>]>,
    pub token: Arc<str>,
    pub site: Arc<Site>,
    pub readonly: bool,
}

/// A robot that is shown.
pub struct Served {
    pub name: String,
    pub shared: Arc<Shared>,
    pub source: Arc<dyn Source>,
    /// `true` if the robot can be started again, and thus go back in time.
    pub travels: bool,
    /// The robot beside it, if it has a shadow or is one.
    pub beside: Option<Beside>,
}

/// Serves pages until `stop` is complete.
pub async fn serve(serving: Serving, listener: TcpListener, stop: impl Future<Output = ()> + Send + 'static) {
    let router =
        FILES.iter().fold(Router::new(), |router, file| router.route(file.path, get(|| async { file.response() })));
    let first = if serving.robots.is_empty() { &STUDY } else { &ROBOT };
    let router = router
        .route("/", get(|| async { first.response() }))
        .route("/live", get(live))
        .route("/follow", get(follow))
        .route(
            "/foxglove/{token}",
            get(|serving, headers, Path(token), upgrade| app(serving, headers, token, 0, upgrade)),
        )
        .route(
            "/foxglove/{token}/{robot}",
            get(|serving, headers, Path((token, robot)), upgrade| app(serving, headers, token, robot, upgrade)),
        )
        .with_state(serving);
    tokio::select! {
        () = connections::accept(listener, router) => {}
        () = stop => {}
    }
}

/// A file of the page, embedded in the program.
struct File {
    path: &'static str,
    kind: &'static str,
    text: &'static str,
}

/// The page of a robot.
const ROBOT: File = File { path: "/robot", kind: "text/html; charset=utf-8", text: include_str!("../page/index.html") };
/// The page of a study.
const STUDY: File = File { path: "/study", kind: "text/html; charset=utf-8", text: include_str!("../page/study.html") };

const FILES: [File; 23] = [
    ROBOT,
    STUDY,
    File { path: "/studio.css", kind: "text/css; charset=utf-8", text: include_str!("../page/studio.css") },
    File { path: "/page.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/page.js") },
    File { path: "/study.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/study.js") },
    File {
        path: "/candidates.js",
        kind: "text/javascript; charset=utf-8",
        text: include_str!("../page/candidates.js"),
    },
    File { path: "/course.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/course.js") },
    File { path: "/why.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/why.js") },
    File { path: "/moment.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/moment.js") },
    File { path: "/studio.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/studio.js") },
    File { path: "/picture.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/picture.js") },
    File { path: "/activity.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/activity.js") },
    File { path: "/names.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/names.js") },
    File { path: "/labels.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/labels.js") },
    File { path: "/timeline.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/timeline.js") },
    File { path: "/params.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/params.js") },
    File { path: "/values.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/values.js") },
    File { path: "/cdr.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/cdr.js") },
    File { path: "/drawn.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/drawn.js") },
    File { path: "/space.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/space.js") },
    File { path: "/world.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/world.js") },
    File { path: "/area.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/area.js") },
    File { path: "/text.js", kind: "text/javascript; charset=utf-8", text: include_str!("../page/text.js") },
];

impl File {
    fn response(&self) -> Response {
        let headers = [
            (header::CONTENT_TYPE, self.kind),
            (header::CONTENT_SECURITY_POLICY, POLICY),
            (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
            (header::CACHE_CONTROL, "no-store"),
        ];
        (headers, self.text).into_response()
    }
}

/// Serves the page of a robot.
async fn live(State(serving): State<Serving>, headers: HeaderMap, upgrade: WebSocketUpgrade) -> Response {
    page(serving, &headers, upgrade, RobotPage::begin)
}

/// Serves the page of a study.
async fn follow(State(serving): State<Serving>, headers: HeaderMap, upgrade: WebSocketUpgrade) -> Response {
    page(serving, &headers, upgrade, StudyPage::begin)
}

/// Serves a page that `begin` returns with the first message to it.
fn page<P: Page>(
    serving: Serving,
    headers: &HeaderMap,
    upgrade: WebSocketUpgrade,
    begin: fn(Serving) -> Option<(P, P::Told)>,
) -> Response {
    if let Err(why) = serving.site.admits(headers) {
        return (StatusCode::FORBIDDEN, why).into_response();
    }
    upgrade.max_message_size(MAX_MESSAGE).on_upgrade(move |socket| talk(serving, socket, begin))
}

/// Serves an app of Foxglove. It comes from another site, or from none, and has the token in its address.
async fn app(
    State(serving): State<Serving>,
    headers: HeaderMap,
    token: String,
    robot: usize,
    upgrade: WebSocketUpgrade,
) -> Response {
    if !serving.site.is_own_host(&headers) || !is_same(token.as_bytes(), serving.token.as_bytes()) {
        return (StatusCode::FORBIDDEN, "open the address that `apex studio` has printed").into_response();
    }
    let seen = task::spawn_blocking(move || serving.robots.get(robot).map(|robot| robot.seen(serving.readonly)));
    let Ok(Some(seen)) = seen.await else {
        return (StatusCode::NOT_FOUND, "the studio has no such robot").into_response();
    };
    let upgrade = upgrade.max_message_size(MAX_MESSAGE).protocols(foxglove::PROTOCOLS);
    if upgrade.selected_protocol().is_none() {
        return (StatusCode::BAD_REQUEST, "the subprotocol `foxglove.sdk.v1` is expected").into_response();
    }
    upgrade.on_upgrade(|socket| foxglove::talk(seen, socket))
}

impl Served {
    /// The robot as an app sees it.
    fn seen(&self, readonly: bool) -> foxglove::Seen {
        let replayed = self.source.replayed().ok().flatten();
        foxglove::Seen { shared: Arc::clone(&self.shared), readonly, travels: self.travels, replayed }
    }
}

impl Serving {
    /// A page of one of the robots.
    fn session(&self, robot: usize) -> Option<Session> {
        let Served { shared, source, travels, beside, .. } = self.robots.get(robot)?;
        Some(Session::new(Arc::clone(shared), beside.clone(), Arc::clone(source), self.readonly, *travels))
    }

    /// The names of all robots. Two of the same kind differ by their addresses.
    fn robots(&self) -> Vec<String> {
        let name = |robot: &Served| {
            let about = robot.shared.live().about.clone();
            about.map_or_else(|| robot.name.clone(), |about| format!("{} ({})", about.name, robot.name))
        };
        self.robots.iter().map(name).collect()
    }

    /// The names of all studies.
    fn studies(&self) -> Vec<String> {
        self.studies.iter().map(|study| study.name.clone()).collect()
    }

    /// The choice at the top of the page of a robot.
    fn names(&self, shown: usize) -> Told {
        Told::Robots { names: self.robots(), shown, studies: self.studies() }
    }

    /// Page of one of the studies, and the choice at its top.
    fn study(&self, shown: usize) -> Option<(study::Page, study::Told)> {
        let page = study::Page::new(Arc::clone(self.studies.get(shown)?));
        Some((page, study::Told::Studies { names: self.studies(), shown, robots: self.robots() }))
    }
}

/// Takes the token with which a page begins. Returns `false` if it is wrong.
async fn has_token(serving: &Serving, socket: &mut WebSocket) -> bool {
    let token = time::timeout(PATIENCE, socket.recv()).await;
    let is_right =
        matches!(&token, Ok(Some(Ok(Message::Text(text)))) if is_same(text.as_bytes(), serving.token.as_bytes()));
    if !is_right {
        // The page says what to do.
        let _ = socket.send(Message::Text("{\"refused\":null}".into())).await;
    }
    is_right
}

/// A page in a browser.
trait Page: Send + 'static {
    /// Message to the page.
    type Told: Serialize + Send + Sync + 'static;

    /// Changes since the last time.
    fn news(&mut self) -> Vec<Self::Told>;

    /// Answer to a message of the page, which may be anything.
    fn answer(&mut self, text: &str) -> Vec<Self::Told>;
}

/// The page of a robot.
struct RobotPage {
    serving: Serving,
    session: Session,
}

impl RobotPage {
    fn begin(serving: Serving) -> Option<(Self, Told)> {
        let (session, names) = (serving.session(0)?, serving.names(0));
        Some((Self { serving, session }, names))
    }
}

impl Page for RobotPage {
    type Told = Told;

    fn news(&mut self) -> Vec<Told> {
        self.session.news()
    }

    fn answer(&mut self, text: &str) -> Vec<Told> {
        let told = match serde_json::from_str(text) {
            Ok(Asked::Robot(robot)) => self.serving.session(robot).map(|mut other| {
                other.look_like(&self.session);
                self.session = other;
                self.serving.names(robot)
            }),
            Ok(asked) => self.session.answer(asked),
            Err(_) => None,
        };
        told.into_iter().collect()
    }
}

/// The page of a study.
struct StudyPage {
    serving: Serving,
    page: study::Page,
}

impl StudyPage {
    fn begin(serving: Serving) -> Option<(Self, study::Told)> {
        let (page, names) = serving.study(0)?;
        Some((Self { serving, page }, names))
    }
}

impl Page for StudyPage {
    type Told = study::Told;

    fn news(&mut self) -> Vec<study::Told> {
        self.page.news()
    }

    fn answer(&mut self, text: &str) -> Vec<study::Told> {
        let told = match serde_json::from_str(text) {
            Ok(study::Asked::Study(number)) => self.serving.study(number).map(|(other, names)| {
                self.page = other;
                names
            }),
            Ok(asked) => self.page.answer(&asked),
            Err(_) => None,
        };
        told.into_iter().collect()
    }
}

/// Talks to a page until it leaves.
async fn talk<P: Page>(serving: Serving, mut socket: WebSocket, begin: fn(Serving) -> Option<(P, P::Told)>) {
    if !has_token(&serving, &mut socket).await {
        return;
    }
    let Ok(Some((page, names))) = task::spawn_blocking(move || begin(serving)).await else { return };
    if !send(&mut socket, &names).await {
        return;
    }
    let (mut page, mut tick) = (Worker(page), time::interval(TICK));
    // A page that was slow gets the newest state, not all that it missed.
    tick.set_missed_tick_behavior(time::MissedTickBehavior::Skip);
    loop {
        let worked = tokio::select! {
            _ = tick.tick() => page.work(P::news).await,
            message = socket.recv() => match message {
                Some(Ok(Message::Text(text))) => page.work(move |page| page.answer(&text)).await,
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
                Some(Ok(_)) => continue,
            },
        };
        let Some((worker, told)) = worked else { return };
        page = worker;
        for told in told {
            if !send(&mut socket, &told).await {
                return;
            }
        }
    }
}

/// Sends a message. Returns `false` if the page is gone.
async fn send(socket: &mut WebSocket, told: &impl Serialize) -> bool {
    let Ok(text) = serde_json::to_string(told) else { return false };
    matches!(time::timeout(PATIENCE, socket.send(Message::Text(text.into()))).await, Ok(Ok(())))
}

/// Compares all bytes, so that the time says nothing about the token.
fn is_same(given: &[u8], token: &[u8]) -> bool {
    given.len() == token.len() && given.iter().zip(token).fold(0, |wrong, (a, b)| wrong | (a ^ b)) == 0
}
