//! `apex top`: a running robot in a terminal.

use crate::{
    live::{Live, Run},
    robot::{Remote, Shared, follow},
    words::one_line,
};
use apex_rt::studio::message::Command;
use crossterm::{
    cursor,
    event::{self, Event, KeyCode, KeyEventKind, KeyModifiers},
    execute, queue, style, terminal,
};
use std::{
    collections::VecDeque,
    io::{self, Write as _},
    sync::Arc,
    thread,
    time::Duration,
};

/// Interval between two pictures.
const TICK: Duration = Duration::from_millis(250);
/// Number of pictures over which rates are measured: two seconds.
const MEASURED: usize = 8;

/// Shows a robot until `q` or Ctrl-C.
///
/// # Errors
/// The terminal cannot be used.
pub fn top(mut robot: Remote) -> io::Result<()> {
    let shared = Arc::<Shared>::default();
    let following = Arc::clone(&shared);
    thread::Builder::new().name("robot".to_owned()).spawn(move || follow(&mut robot, &following, None))?;
    terminal::enable_raw_mode()?;
    let shown = execute!(io::stdout(), terminal::EnterAlternateScreen, cursor::Hide).and_then(|()| show(&shared));
    shared.end();
    // The terminal has to be usable again, whatever happened.
    let left = execute!(io::stdout(), cursor::Show, terminal::LeaveAlternateScreen);
    terminal::disable_raw_mode()?;
    shown.and(left)
}

fn show(shared: &Shared) -> io::Result<()> {
    let mut rates = Rates::default();
    loop {
        let (width, height) = terminal::size()?;
        let lines = {
            let live = shared.live();
            rates.measure(&live);
            lines(&live, &rates, height.into())
        };
        let mut out = io::stdout().lock();
        queue!(out, cursor::MoveTo(0, 0))?;
        for (at, line) in lines.iter().enumerate() {
            let line: String = line.chars().take(width.into()).collect();
            queue!(out, cursor::MoveTo(0, at as u16), style::Print(line))?;
            queue!(out, terminal::Clear(terminal::ClearType::UntilNewLine))?;
        }
        queue!(out, terminal::Clear(terminal::ClearType::FromCursorDown))?;
        out.flush()?;
        if event::poll(TICK)? && !obey(&event::read()?, shared) {
            return Ok(());
        }
    }
}

/// Obeys a key. Returns `false` at the end.
fn obey(event: &Event, shared: &Shared) -> bool {
    let Event::Key(key) = event else { return true };
    if key.kind != KeyEventKind::Press {
        return true;
    }
    match key.code {
        KeyCode::Char('q') | KeyCode::Esc => return false,
        KeyCode::Char('c') if key.modifiers.contains(KeyModifiers::CONTROL) => return false,
        KeyCode::Char('.') => shared.tell(&Command::Step),
        KeyCode::Char(' ') => {
            let (paused, speed) = (shared.live().paused, shared.live().speed);
            shared.tell(&if paused { Command::Run { speed } } else { Command::Pause });
        }
        _ => {}
    }
    true
}

/// Firings per second of the robot's time.
#[derive(Default)]
struct Rates {
    runs: u64,
    /// Times in ns, and numbers of firings of each node.
    counts: VecDeque<(i64, Vec<u64>)>,
    rates: Vec<f64>,
}

impl Rates {
    fn measure(&mut self, live: &Live) {
        if live.runs != self.runs {
            *self = Self { runs: live.runs, ..Self::default() };
        }
        let now: Vec<u64> = live.nodes.iter().map(|node| node.fired).collect();
        let (start, before) = self.counts.front().cloned().unwrap_or_else(|| (live.now, now.clone()));
        let seconds = (live.now - start) as f64 / 1e9;
        let rate = |(now, before): (&u64, &u64)| if seconds > 0.0 { (now - before) as f64 / seconds } else { 0.0 };
        self.rates = now.iter().zip(&before).map(rate).collect();
        self.counts.push_back((live.now, now));
        if self.counts.len() > MEASURED {
            self.counts.pop_front();
        }
    }
}

/// The picture, in at most `height` lines.
fn lines(live: &Live, rates: &Rates, height: usize) -> Vec<String> {
    let run = match &live.run {
        Run::Starting(what) | Run::Lost(what) => what.clone(),
        Run::Running if live.silence().is_some() => live.silence().unwrap_or_default(),
        Run::Running if live.paused => "halted".to_owned(),
        Run::Running => "running".to_owned(),
        Run::Ended => "ended".to_owned(),
    };
    let Some(about) = &live.about else { return vec![run, "q: quit".to_owned()] };
    let seconds = |time: i64| time as f64 / 1e9;
    let keys = if about.simulated { "space: halt or continue   .: step   q: quit" } else { "q: quit" };
    let mut lines = vec![format!("{}   {run}   {:.3} s   {keys}", about.name, seconds(live.now))];
    if live.lost > 0 {
        lines.push(format!("{} messages lost", live.lost));
    }
    let named = |at: usize| about.nodes.get(at).map_or("?", |node| node.name.as_str());
    lines.extend([String::new(), "ACTIVE".to_owned()]);
    let active = live.nodes.iter().enumerate().filter(|(_, node)| node.active);
    lines.extend(active.map(|(at, node)| format!("  {:8.1} s  {}", seconds(live.now - node.since), named(at))));
    let problems: Vec<String> = live
        .problems
        .iter()
        .rev()
        .take(5)
        .map(|problem| {
            let node = problem.node.map_or_else(String::new, |node| format!("{}: ", named(node as usize)));
            format!("  {:8.3} s  {node}{}", problem.at, one_line(&problem.text))
        })
        .collect();
    if !problems.is_empty() {
        lines.extend([String::new(), format!("PROBLEMS ({})", live.problem_count)]);
        lines.extend(problems);
    }
    lines.extend([String::new(), "    RATE     FIRED     TAKEN  LAST".to_owned()]);
    let mut nodes: Vec<usize> =
        (0..live.nodes.len()).filter(|at| live.nodes[*at].fired + live.nodes[*at].taken > 0).collect();
    nodes.sort_by(|a, b| rates.rates[*b].total_cmp(&rates.rates[*a]).then(a.cmp(b)));
    lines.extend(nodes.into_iter().map(|at| {
        let (node, rate) = (&live.nodes[at], rates.rates[at]);
        let ago = seconds(live.now - node.last);
        format!("{rate:6.1}/s {:9} {:9}  {ago:8.3} s ago  {}", node.fired, node.taken, named(at))
    }));
    lines.truncate(height);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::robot;
    use apex_rt::studio::message::{About, AboutConnection, Report};

    #[test]
    fn a_robot_is_shown_in_lines() {
        let (mut live, mut rates) = (Live::default(), Rates::default());
        assert_eq!(lines(&live, &rates, 24), ["starting", "q: quit"]);
        let (output, input) = ("twist".to_owned(), "drive".to_owned());
        let connections = vec![AboutConnection { from: 1, output, to: 0, input, activity: false }];
        live.note(Report::About(About { name: "Rover".to_owned(), connections, ..robot(&["base", "go.drive"]) }));
        rates.measure(&live);
        live.note(Report::Activity { node: 1, active: true });
        for now in 1..=20 {
            live.note(Report::Reaction { group: 0, now: now * 100_000_000 });
            live.note(Report::Fired(0));
        }
        // A token at a slot is not a firing.
        live.note(Report::Handled(0));
        live.note(Report::Failed { node: 0, error: "no\u{1b}[2J scan".to_owned() });
        rates.measure(&live);
        let shown = lines(&live, &rates, 24);
        assert_eq!(
            shown,
            [
                "Rover   running   2.000 s   q: quit",
                "",
                "ACTIVE",
                "       2.0 s  go.drive",
                "",
                "PROBLEMS (1)",
                "     2.000 s  base: no [2J scan",
                "",
                "    RATE     FIRED     TAKEN  LAST",
                "  10.0/s        20         1     0.000 s ago  base",
            ]
        );
        assert_eq!(lines(&live, &rates, 3).len(), 3);
        // A robot that stands still, or a cable that is out.
        live.note(Report::Alive(vec![(20, false)]));
        assert!(lines(&live, &rates, 24)[0].starts_with("Rover   running   "));
        live.hear(std::time::Instant::now() - Duration::from_secs(4));
        assert!(lines(&live, &rates, 24)[0].starts_with("Rover   no news for 4 s   "));
    }
}
