use std::fmt;

/// A value or ⊥.
pub type Token = Option<i64>;

/// A kind of node: its notation, its ports and its behaviour.
pub struct Kind {
    /// Name in Rust.
    pub name: &'static str,
    /// Inputs.
    pub inputs: &'static [&'static str],
    /// Number of optional inputs, which are the last ones.
    pub optional: usize,
    /// Outputs.
    pub outputs: &'static [&'static str],
    /// `true` if it is notified of ⊥ at its mandatory inputs.
    pub told: bool,
    /// Parameter, with the range of its values.
    pub parameter: Option<(&'static str, std::ops::Range<i64>)>,
    /// Computes the tokens to send from the state, the parameter and the inputs.
    pub fire: fn(&mut State, i64, &[Token]) -> Vec<Token>,
}

/// State of a node.
#[derive(Debug, Clone, Default)]
pub struct State {
    /// A number.
    pub number: i64,
    /// Last value.
    pub last: Token,
    /// Tokens that a sink wrote.
    pub tape: Vec<Token>,
}

impl fmt::Debug for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

const fn plain(
    name: &'static str,
    inputs: &'static [&'static str],
    fire: fn(&mut State, i64, &[Token]) -> Vec<Token>,
) -> Kind {
    Kind { name, inputs, optional: 0, outputs: &["out"], told: false, parameter: None, fire }
}

/// The value of a mandatory input.
fn value(tokens: &[Token], input: usize) -> i64 {
    tokens[input].unwrap_or_default()
}

fn some_if(condition: bool, value: i64) -> Token {
    condition.then_some(value)
}

/// A source that ends.
pub const COUNT: Kind = Kind {
    parameter: Some(("end", 0..14)),
    ..plain("Count", &[], |s, end, _| {
        s.number += 1;
        vec![some_if(s.number <= end, s.number - 1)]
    })
};

/// A source that is never ⊥.
pub const ONE_BASED: Kind = plain("OneBased", &[], |s, _, _| {
    s.number += 1;
    vec![Some(s.number)]
});

/// Nodes with inputs and outputs.
pub const OPERATIONS: &[Kind] = &[
    Kind { parameter: Some(("k", 0..3)), ..plain("mul", &["x"], |_, k, t| vec![Some(k * value(t, 0))]) },
    plain("add", &["a", "b"], |_, _, t| vec![Some(value(t, 0) + value(t, 1))]),
    plain("add", &["a", "b"], |_, _, t| vec![Some(value(t, 0) + value(t, 1))]),
    plain("offset", &["x", "by"], |_, _, t| vec![Some(value(t, 0) + value(t, 1))]),
    plain("total_of_five", &["a", "b", "c", "d", "e"], |_, _, t| vec![Some((0..5).map(|i| value(t, i)).sum())]),
    plain("total", &["values", "values", "values"], |_, _, t| vec![Some((0..3).map(|i| value(t, i)).sum())]),
    Kind {
        optional: 4,
        ..plain("weigh", &["offset", "values", "values", "values", "values"], |_, _, t| vec![Some(weighed(t))])
    },
    Kind {
        told: true,
        ..plain("Census", &["values", "values"], |s, _, t| {
            let [Some(a), Some(b)] = t else { return vec![None] };
            s.number += a.max(b);
            vec![Some(s.number % 1009)]
        })
    },
    plain("drop_odd", &["x"], |_, _, t| vec![some_if(value(t, 0) % 2 == 0, value(t, 0))]),
    Kind {
        parameter: Some(("of", 2..4)),
        ..plain("keep_multiples", &["x"], |_, of, t| vec![some_if(value(t, 0) % of == 0, value(t, 0))])
    },
    Kind { optional: 1, ..plain("add_or", &["x", "by"], |_, _, t| vec![Some(value(t, 0) + t[1].unwrap_or(100))]) },
    Kind {
        optional: 2,
        ..plain("both_or", &["a", "b"], |_, _, t| {
            let any = t[0].or(t[1]).is_some();
            vec![some_if(any, t[0].unwrap_or(0) + 10 * t[1].unwrap_or(0))]
        })
    },
    Kind {
        parameter: Some(("at", 0..9)),
        ..plain("fails_at", &["x"], |_, at, t| vec![some_if(value(t, 0) != at, value(t, 0))])
    },
    plain("odd_fails", &["x"], |_, _, t| vec![some_if(value(t, 0) % 4 == 0, value(t, 0))]),
    Kind { outputs: &["even", "odd"], ..plain("switch", &["x"], |_, _, t| switch(value(t, 0))) },
    Kind {
        outputs: &["even", "odd"],
        parameter: Some(("limit", 3..30)),
        ..plain("switch_checked", &["x"], |_, limit, t| match value(t, 0) {
            x if x % 5 == 0 || x >= limit => vec![None, None],
            x => switch(x),
        })
    },
    Kind {
        outputs: &["plus", "minus"],
        ..plain("negate_odd", &["x"], |_, _, t| vec![t[0], some_if(value(t, 0) % 2 != 0, -value(t, 0))])
    },
    Kind {
        outputs: &["y"],
        ..plain("doubled_in_place", &["x"], |_, _, t| vec![some_if(value(t, 0) % 3 != 0, 2 * value(t, 0))])
    },
    Kind {
        outputs: &["twos", "threes"],
        ..plain("split_buffered", &["x"], |_, _, t| {
            let x = value(t, 0);
            vec![some_if(x % 2 == 0, x), some_if(x % 3 == 0, x)]
        })
    },
    plain("Accumulate", &["x"], |s, _, t| {
        s.number = (s.number + value(t, 0)) % 1009;
        vec![Some(s.number)]
    }),
    plain("Accumulate", &["x"], |s, _, t| {
        s.number = (s.number + value(t, 0)) % 1009;
        vec![Some(s.number)]
    }),
    plain("Rise", &["x"], |s, _, t| {
        let before = s.last.replace(value(t, 0));
        vec![some_if(before.is_none_or(|b| b < value(t, 0)), value(t, 0))]
    }),
    Kind {
        parameter: Some(("n", 1..4)),
        ..plain("Throttle", &["x"], |s, n, t| {
            s.number += 1;
            vec![some_if(s.number % n == 0, value(t, 0))]
        })
    },
    Kind {
        optional: 1,
        ..plain("Latch<i64>", &["x"], |s, _, t| {
            s.last = t[0].or(s.last);
            vec![s.last]
        })
    },
];

/// Sinks. Their parameter is their identifier.
pub const SINKS: &[Kind] = &[
    Kind { outputs: &[], ..plain("tape", &["x"], wind) },
    Kind { outputs: &[], ..plain("tape", &["x"], wind) },
    Kind { outputs: &[], optional: 1, ..plain("tape_all", &["x"], wind) },
    Kind { outputs: &[], told: true, ..plain("TapeKeen", &["x"], wind) },
];

fn wind(state: &mut State, _: i64, tokens: &[Token]) -> Vec<Token> {
    state.tape.push(tokens[0]);
    vec![]
}

/// `weigh`
fn weighed(tokens: &[Token]) -> i64 {
    let weighted = (1..tokens.len()).map(|i| i as i64 * tokens[i].unwrap_or(0));
    1000 * (tokens.len() as i64 - 1) + value(tokens, 0) + weighted.sum::<i64>()
}

fn switch(x: i64) -> Vec<Token> {
    vec![some_if(x % 2 == 0, x), some_if(x % 2 != 0, x)]
}
