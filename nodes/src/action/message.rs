//! Recordings of orders and reports. They are not messages of ROS, whose actions are services: the goal, feedback or
//! result in one is a message within the message.

use super::{End, GoalId, Loss, Order, Report};
use apex_messages::{
    Message, Reason,
    cdr::{Reader, Writer},
};

/// Fields that orders and reports have: kind, goal, another goal if there is one, and a message as bytes.
struct Parts {
    kind: u8,
    id: GoalId,
    replaces: Option<GoalId>,
    content: Vec<u8>,
}

const DEFINITION: &str = "uint8 kind\nuint8[16] goal_id\nbool has_other\nuint8[16] other_id\nuint8[] content";

impl Parts {
    fn new(kind: u8, id: GoalId) -> Self {
        Self { kind, id, replaces: None, content: vec![] }
    }

    fn write(&self, to: &mut Writer<'_>) {
        to.number(self.kind);
        to.numbers(&self.id.0.to_be_bytes());
        to.number(u8::from(self.replaces.is_some()));
        to.numbers(&self.replaces.unwrap_or_default().0.to_be_bytes());
        to.length(self.content.len());
        to.numbers(&self.content);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
        let kind = from.number()?;
        let id = GoalId(u128::from_be_bytes(from.array()?));
        let has_other = from.number::<u8>()? != 0;
        let other = GoalId(u128::from_be_bytes(from.array()?));
        Ok(Self { kind, id, replaces: has_other.then_some(other), content: from.list(usize::MAX)? })
    }
}

const UNKNOWN: Reason = Reason::Borrowed("its kind is not known");

impl<G: Message> Message for Order<G> {
    const NAME: &'static str = "apex/msg/ActionOrder";
    const DEFINITION: &'static str = DEFINITION;

    fn write(&self, to: &mut Writer<'_>) {
        let parts = match self {
            Self::Send { id, goal, replaces } => {
                Parts { replaces: *replaces, content: goal.to_bytes(), ..Parts::new(0, *id) }
            }
            Self::Cancel { id } => Parts::new(1, *id),
        };
        parts.write(to);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
        let Parts { kind, id, replaces, content } = Parts::read(from)?;
        match kind {
            0 => Ok(Self::Send { id, goal: G::from_bytes(&content)?, replaces }),
            1 => Ok(Self::Cancel { id }),
            _ => Err(UNKNOWN),
        }
    }
}

/// Kinds of reports. Those of ends and losses follow the first ones.
const ACCEPTED: u8 = 0;
const REJECTED: u8 = 1;
const FEEDBACK: u8 = 2;
const ENDS: [End; 3] = [End::Succeeded, End::Canceled, End::Aborted];
const FIRST_END: u8 = 3;
const LOSSES: [Loss; 4] = [Loss::NoServer, Loss::NoAnswer, Loss::ServerGone, Loss::Forgotten];
const FIRST_LOSS: u8 = FIRST_END + ENDS.len() as u8;
const ALL_ABORTED: u8 = FIRST_LOSS + LOSSES.len() as u8;

impl<F: Message, R: Message> Message for Report<F, R> {
    const NAME: &'static str = "apex/msg/ActionReport";
    const DEFINITION: &'static str = DEFINITION;

    fn write(&self, to: &mut Writer<'_>) {
        let parts = match self {
            Self::Accepted { id, replaces } => Parts { replaces: *replaces, ..Parts::new(ACCEPTED, *id) },
            Self::Rejected { id } => Parts::new(REJECTED, *id),
            Self::Feedback { id, feedback } => Parts { content: feedback.to_bytes(), ..Parts::new(FEEDBACK, *id) },
            Self::Ended { id, end, result } => {
                Parts { content: result.to_bytes(), ..Parts::new(FIRST_END + *end as u8, *id) }
            }
            Self::Lost { id, loss } => Parts::new(FIRST_LOSS + *loss as u8, *id),
            Self::AllAborted => Parts::new(ALL_ABORTED, GoalId::default()),
        };
        parts.write(to);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
        let Parts { kind, id, replaces, content } = Parts::read(from)?;
        let end = |kind: u8| ENDS.get(usize::from(kind.checked_sub(FIRST_END)?)).copied();
        let loss = |kind: u8| LOSSES.get(usize::from(kind.checked_sub(FIRST_LOSS)?)).copied();
        match kind {
            ACCEPTED => Ok(Self::Accepted { id, replaces }),
            REJECTED => Ok(Self::Rejected { id }),
            ALL_ABORTED => Ok(Self::AllAborted),
            FEEDBACK => Ok(Self::Feedback { id, feedback: F::from_bytes(&content)? }),
            _ => match (end(kind), loss(kind)) {
                (Some(end), _) => Ok(Self::Ended { id, end, result: R::from_bytes(&content)? }),
                (None, Some(loss)) => Ok(Self::Lost { id, loss }),
                (None, None) => Err(UNKNOWN),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_come_back() {
        let id = GoalId(u128::MAX - 7);
        let other = [None, Some(GoalId(0)), Some(GoalId(9))];
        for replaces in other {
            let order = Order::Send { id, goal: 1.5_f64, replaces };
            assert_eq!(Order::from_bytes(&order.to_bytes()), Ok(order));
        }
        let order: Order<f64> = Order::Cancel { id };
        assert_eq!(Order::from_bytes(&order.to_bytes()), Ok(order));
        let accepted = other.map(|replaces| Report::Accepted { id, replaces });
        let ended = ENDS.map(|end| Report::Ended { id, end, result: "r".to_owned() });
        let lost = LOSSES.map(|loss| Report::Lost { id, loss });
        let rest = [Report::Rejected { id }, Report::Feedback { id, feedback: 0.5_f64 }, Report::AllAborted];
        for report in accepted.into_iter().chain(ended).chain(lost).chain(rest) {
            assert_eq!(Report::<f64, String>::from_bytes(&report.to_bytes()), Ok(report));
        }
        let mut bytes = Report::<f64, String>::Rejected { id }.to_bytes();
        bytes[4] = 77;
        assert!(Report::<f64, String>::from_bytes(&bytes).is_err());
    }
}
