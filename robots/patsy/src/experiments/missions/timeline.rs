use super::Run;
use crate::world::clinic::Delivery;
use apex_rt::Time;
use apex_sim::experiment;

/// Events and activity of a run, with the times in s.
pub fn timeline(run: &Run) -> String {
    let report = &run.report;
    let mut events: Vec<(Time, String)> = vec![];
    let mut event = |at: Time, what: String| events.push((at, what));
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
    experiment::timeline(&run.timeline, &report.trajectory, &events)
}
