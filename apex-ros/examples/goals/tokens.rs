//! Tokens of the tests of `goals.afg`: the first goal, its orders, and reports of it.
#![allow(dead_code, reason = "only the tests of the graphs use them")]

use apex_messages::example_interfaces::{FibonacciFeedback, FibonacciGoal, FibonacciResult};
use apex_nodes::action::{End, GoalId, Order, Report};

type Told = Report<FibonacciFeedback, FibonacciResult>;

const ID: GoalId = GoalId(1);
const NOTHING: FibonacciResult = FibonacciResult { sequence: vec![] };

/// Goal.
pub const FIVE: FibonacciGoal = FibonacciGoal { order: 5 };
/// Order to carry it out.
pub const GOAL: Order<FibonacciGoal> = Order::Send { id: ID, goal: FIVE, replaces: None };
/// Order that calls it off.
pub const CANCEL: Order<FibonacciGoal> = Order::Cancel { id: ID };
/// End with success.
pub const REACHED: Told = Report::Ended { id: ID, end: End::Succeeded, result: NOTHING };
/// End without success.
pub const ABORTED: Told = Report::Ended { id: ID, end: End::Aborted, result: NOTHING };
/// Refusal.
pub const REFUSED: Told = Report::Rejected { id: ID };
