use super::Run;
use crate::world::clinic::Delivery;
use apex_rt::Time;

/// Events and activity of a run, with the times in s: a line for each time in which a node was active, and one for each
/// event of the report.
pub fn timeline(run: &Run) -> String {
    let report = &run.report;
    let pose = |at: Time| report.trajectory.iter().take_while(|(time, _)| *time <= at).last().map(|(_, pose)| *pose);
    let spell = |(from, until): (Time, Time)| {
        format!("{:8.2} s for {:6.2} s", from.as_secs_f64(), until.since(from).as_secs_f64())
    };
    let mut lines: Vec<(Time, String)> = run
        .timeline
        .iter()
        .map(|active| {
            let at =
                pose(active.from).map_or(String::new(), |at| format!("({:.2}, {:.2}, {:.2})", at.x, at.y, at.theta));
            (active.from, format!("{} {at:<22} {}", spell((active.from, active.until)), active.node))
        })
        .collect();
    let mut event = |at: Time, what: String| lines.push((at, format!("{:8.2} s: {what}", at.as_secs_f64())));
    for Delivery { at, container, offset, turn, left, .. } in &report.deliveries {
        let left = left.map_or("never".to_owned(), |left| format!("at {:.2} s", left.as_secs_f64()));
        let turn = turn.to_degrees();
        event(*at, format!("container {container} set down, {offset:.2} m and {turn:.0}° off, left {left}"));
    }
    report.bumps.iter().for_each(|at| event(*at, "bump".to_owned()));
    report.contacts.iter().for_each(|contact| event(contact.at, format!("contact with person {}", contact.person)));
    report.falls.iter().for_each(|at| event(*at, "fall".to_owned()));
    report.run_over.iter().for_each(|(at, thing)| event(*at, format!("{thing:?} run over")));
    report.empty_lifts.iter().for_each(|at| event(*at, "empty lift".to_owned()));
    report.wedges.iter().for_each(|at| event(*at, "wedged".to_owned()));
    lines.sort_by_key(|(at, _)| *at);
    lines.into_iter().fold(String::new(), |text, (_, line)| text + &line + "\n")
}
