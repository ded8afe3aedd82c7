//! Tokens between the client and the server of an action.

/// Identification of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GoalId(pub u128);

/// Order of a client to a server.
#[derive(Debug, Clone, PartialEq)]
pub enum Order<G> {
    /// Carries out a goal.
    Send {
        /// Identification of the goal.
        id: GoalId,
        /// Goal.
        goal: G,
        /// Earlier goal that the client calls off for this one.
        replaces: Option<GoalId>,
    },
    /// Calls off a goal.
    Cancel {
        /// Identification of the goal.
        id: GoalId,
    },
}

/// Report of a server to its client.
#[derive(Debug, Clone, PartialEq)]
pub enum Report<F, R> {
    /// The goal will be carried out.
    Accepted {
        /// Identification of the goal.
        id: GoalId,
        /// Goal that was accepted earlier and had not begun: it is aborted for this one.
        replaces: Option<GoalId>,
    },
    /// The goal will not be carried out.
    Rejected {
        /// Identification of the goal.
        id: GoalId,
    },
    /// Message on the way to the goal.
    Feedback {
        /// Identification of the goal.
        id: GoalId,
        /// Message.
        feedback: F,
    },
    /// The goal has ended.
    Ended {
        /// Identification of the goal.
        id: GoalId,
        /// End of the goal.
        end: End,
        /// Result.
        result: R,
    },
    /// All goals that were accepted have ended: aborted.
    AllAborted,
    /// Nothing more will be heard of the goal.
    Lost {
        /// Identification of the goal.
        id: GoalId,
        /// Reason.
        loss: Loss,
    },
}

/// End of a goal that was accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum End {
    /// It was reached.
    Succeeded,
    /// It was called off.
    Canceled,
    /// It was given up by the server.
    Aborted,
}

/// Reason why nothing more will be heard of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Loss {
    /// No program serves the action.
    #[default]
    NoServer,
    /// The server has not answered.
    NoAnswer,
    /// The server that had accepted the goal has gone.
    ServerGone,
    /// The server does not know the goal any more, for example because it was started again.
    Forgotten,
}

impl<F, R> Report<F, R> {
    /// Identification of the goal; `None` if it is a report of all goals.
    pub fn id(&self) -> Option<GoalId> {
        match self {
            Self::Accepted { id, .. }
            | Self::Rejected { id }
            | Self::Feedback { id, .. }
            | Self::Ended { id, .. }
            | Self::Lost { id, .. } => Some(*id),
            Self::AllAborted => None,
        }
    }

    /// Returns `true` if a goal is over with this report.
    pub fn ends(&self, goal: GoalId) -> bool {
        match self {
            Self::Accepted { replaces, .. } => *replaces == Some(goal),
            Self::Feedback { .. } => false,
            Self::AllAborted => true,
            Self::Rejected { id } | Self::Ended { id, .. } | Self::Lost { id, .. } => *id == goal,
        }
    }
}
