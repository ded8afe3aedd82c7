use super::Spell;
use apex_nodes::scan::Pose2;
use apex_rt::Time;

/// Events and activity of a run in the order of their times: a line for each time in which a node was active, with the
/// last pose of the robot before it, and one for each event. `trajectory` has poses in the order of their times.
pub fn timeline(spells: &[Spell], trajectory: &[(Time, Pose2)], events: &[(Time, String)]) -> String {
    let pose = |at: Time| trajectory[..trajectory.partition_point(|(time, _)| *time <= at)].last();
    let spell = |Spell { node, from, until }: &Spell| {
        let lasted = until.since(*from).as_secs_f64();
        let at = pose(*from).map_or(String::new(), |(_, at)| format!("({:.2}, {:.2}, {:.2})", at.x, at.y, at.theta));
        (*from, format!("{:8.2} s for {lasted:6.2} s {at:<22} {node}", from.as_secs_f64()))
    };
    let event = |(at, what): &(Time, String)| (*at, format!("{:8.2} s: {what}", at.as_secs_f64()));
    let mut lines: Vec<(Time, String)> = spells.iter().map(spell).chain(events.iter().map(event)).collect();
    lines.sort_by_key(|(at, _)| *at);
    lines.into_iter().fold(String::new(), |text, (_, line)| text + &line + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_stand_among_what_was_active() {
        let spell = |node, from, until| Spell { node, from: Time::from_secs(from), until: Time::from_secs(until) };
        let trajectory = [1, 2, 3].map(|s| (Time::from_secs(s), Pose2::new(s as f32, 0.0, 0.5)));
        let text = timeline(
            &[spell("search", 2, 5), spell("wait", 0, 1)],
            &trajectory,
            &[(Time::from_secs(1), "bump".into())],
        );
        let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        let expected = ["0.00 s for 1.00 s wait", "1.00 s: bump", "2.00 s for 3.00 s (2.00, 0.00, 0.50) search"];
        assert_eq!(lines, expected.map(|line| line.split(' ').collect::<Vec<_>>()));
    }
}
