//! A run of a [`Model`] as text for people and in a compact form for programs.

use super::model::{Arrival, Model, Move, Place, PlaceId, State};
use crate::graph::{Connection, Graph};

/// Largest number of steps of a run that are shown.
const MAX_STEPS: usize = 40;

/// Largest number of places with initial activity that are shown.
const MAX_STARTS: usize = 6;

/// Steps in one line of the compact form.
const STEPS_IN_LINE: usize = 10;

/// A sentence for each move, then all moves in lines of ten: `run: start; emit a.e; take a.e => b.s`.
pub fn run(graph: &Graph, model: &Model, moves: &[Move]) -> Vec<String> {
    let mut state = model.initial.clone();
    let (mut notes, mut short) = (vec![], vec![]);
    for (number, by) in (1..).zip(moves) {
        let mut next = state.clone();
        if *by != Move::Start {
            model.moves(&state, &mut |found, to| {
                if found == *by {
                    next = to;
                }
            });
        }
        notes.push(format!("{number}. {}", sentence(graph, model, &state, *by)));
        short.push(word(graph, model, *by));
        state = next;
    }
    if notes.len() > MAX_STEPS {
        let left_out = notes.len() - MAX_STEPS;
        notes.splice(MAX_STEPS / 2..notes.len() - MAX_STEPS / 2, [format!("({left_out} more steps)")]);
    }
    // The length of a note is limited.
    notes.extend(short.chunks(STEPS_IN_LINE).map(|steps| format!("run: {}", steps.join("; "))));
    notes
}

fn sentence(graph: &Graph, model: &Model, before: &State, by: Move) -> String {
    match by {
        Move::Start => {
            let given: Vec<String> = before.iter().take(MAX_STARTS).map(|place| given(graph, model, *place)).collect();
            match before.len() {
                0 => "`start` creates no activity".to_owned(),
                count @ ..=MAX_STARTS => format!("`start`: {}", given[..count].join(", ")),
                count => format!("`start`: {}, and {} more", given.join(", "), count - MAX_STARTS),
            }
        }
        Move::Emit(place, number) => {
            let over: Vec<String> = model.emissions[place as usize][number]
                .to
                .iter()
                .map(|to| format!("`{}`", connection(graph, model, *to)))
                .collect();
            format!("`{}` passes its activity on over {}", name(graph, model, place), over.join(" and "))
        }
        Move::Take(place) => match model.arrivals[place as usize] {
            Some(Arrival::Node(node)) if is_joined(model, before, place) => {
                format!(
                    "`{}` takes it and the activity at its other inputs: together they become one",
                    name(graph, model, node)
                )
            }
            Some(Arrival::Node(node)) if before.binary_search(&node).is_ok() => {
                format!("`{}` takes it, but is already active: two become one", name(graph, model, node))
            }
            Some(Arrival::Node(node)) => format!("`{}` takes it and becomes active", name(graph, model, node)),
            Some(Arrival::Cancels(number)) => cancels(graph, model, number),
            Some(Arrival::Resumes(number)) => resumes(graph, model, number),
            Some(Arrival::Restarts) => "`reset` restores the state after `start`".to_owned(),
            _ => format!("it leaves the program over `{}`", connection(graph, model, place)),
        },
        Move::Cancel(number) => cancels(graph, model, number),
        Move::Resume(number) => resumes(graph, model, number),
        Move::Shift(number) => shifts(graph, model, before, number),
        Move::Away(remover, place) => {
            let c = &graph.connections[remover];
            format!("`{}` takes the activity of `{}` away", graph.path(c.from.node), name(graph, model, place))
        }
    }
}

/// Name of the node or nested graph from which an interrupt takes activity.
fn subject(graph: &Graph, model: &Model, number: usize) -> String {
    graph.subject_name(model.interrupts[number].subject)
}

fn cancels(graph: &Graph, model: &Model, number: usize) -> String {
    format!("`{}.cancel` takes all activity away", subject(graph, model, number))
}

fn resumes(graph: &Graph, model: &Model, number: usize) -> String {
    format!("`{}.resume` gives activity back", subject(graph, model, number))
}

/// Returns `true` if more activity is taken with a token at an input.
fn is_joined(model: &Model, before: &State, place: PlaceId) -> bool {
    model.together[place as usize].iter().any(|other| before.binary_search(other).is_ok())
}

fn shifts(graph: &Graph, model: &Model, before: &State, number: usize) -> String {
    let delay = &model.delays[number];
    let name = graph.path(delay.node);
    match (delay.sends_next(before), delay.sends.is_empty()) {
        (true, true) => format!("`{name}` sends the token with activity, which no `=>` passes on"),
        (true, false) => format!("`{name}` sends the token with activity"),
        (false, _) => format!("`{name}` takes a token and sends the one before"),
    }
}

fn given(graph: &Graph, model: &Model, place: PlaceId) -> String {
    match model.places[place as usize] {
        Place::Node(node) | Place::Delayed(node, _) | Place::Remembered(_, node) => {
            format!("`{}` becomes active", graph.path(node))
        }
        Place::Connection(c) => {
            format!("activity is on its way to `{}`", graph.end_name(graph.connections[c].to))
        }
    }
}

fn word(graph: &Graph, model: &Model, by: Move) -> String {
    match by {
        Move::Start => "start".to_owned(),
        Move::Emit(place, number) => format!("emit {}", graph.end_name(model.emissions[place as usize][number].from)),
        Move::Take(place) => format!("take {}", connection(graph, model, place)),
        Move::Cancel(number) => format!("cancel {}", subject(graph, model, number)),
        Move::Resume(number) => format!("resume {}", subject(graph, model, number)),
        Move::Shift(number) => format!("shift {}", graph.path(model.delays[number].node)),
        Move::Away(remover, _) => format!("away {}", arrow(graph, &graph.connections[remover])),
    }
}

/// The node or connection at a place.
fn name(graph: &Graph, model: &Model, place: PlaceId) -> String {
    match model.places[place as usize] {
        Place::Node(node) | Place::Delayed(node, _) | Place::Remembered(_, node) => graph.path(node),
        Place::Connection(c) => arrow(graph, &graph.connections[c]),
    }
}

fn connection(graph: &Graph, model: &Model, place: PlaceId) -> String {
    name(graph, model, place)
}

fn arrow(graph: &Graph, c: &Connection) -> String {
    format!("{} => {}", graph.end_name(c.from), graph.end_name(c.to))
}
