//! Conditions on tokens, which are computed as generated code computes them: in the type of the token, integers in a
//! wide one, and where something has no result the condition does not hold.

use crate::Value;
use apex_dsl::{
    catalog::Type,
    graph::{self, Condition},
};
use apex_rt::Time;
use std::time::Duration;

/// A token or constant that can be compared.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum Scalar {
    Bool(bool),
    /// An integer, or a time in nanoseconds.
    Integer(i128),
    Float(f64),
}

/// Returns `true` if a condition holds for a token of a type.
pub fn holds(condition: &Condition, token: &Value, ty: &Type) -> bool {
    let Some(token) = scalar(token) else { return false };
    Computing { token, ty }.value(condition) == Some(Scalar::Bool(true))
}

fn scalar(token: &Value) -> Option<Scalar> {
    macro_rules! integer {
        ($($ty:ty)*) => {
            None$(.or_else(|| token.downcast_ref::<$ty>().and_then(|number| i128::try_from(*number).ok())))*
        };
    }
    let integer: Option<i128> = integer!(i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize);
    let time = || token.downcast_ref::<Time>().map(|time| i128::from(time.as_nanos()));
    let duration = || token.downcast_ref::<Duration>().and_then(|time| i128::try_from(time.as_nanos()).ok());
    let single = || token.downcast_ref::<f32>().map(|number| f64::from(*number));
    let float = || token.downcast_ref::<f64>().copied().or_else(single).map(Scalar::Float);
    let truth = || token.downcast_ref::<bool>().copied().map(Scalar::Bool);
    integer.or_else(time).or_else(duration).map(Scalar::Integer).or_else(float).or_else(truth)
}

/// Computing with a token.
struct Computing<'a> {
    token: Scalar,
    ty: &'a Type,
}

impl Computing<'_> {
    fn value(&self, condition: &Condition) -> Option<Scalar> {
        match condition {
            Condition::Token => Some(self.token),
            Condition::Constant(value) => self.constant(value),
            Condition::Unary(_, inner) => match self.value(inner)? {
                Scalar::Bool(value) => Some(Scalar::Bool(!value)),
                Scalar::Integer(number) => self.integer(number.checked_neg()),
                Scalar::Float(number) => Some(Scalar::Float(-number)),
            },
            Condition::Binary(a, operator, b) => {
                let a = self.value(a)?;
                match (*operator, a) {
                    ("&&", Scalar::Bool(false)) | ("||", Scalar::Bool(true)) => Some(a),
                    ("&&" | "||", _) => self.value(b),
                    _ => self.binary(a, operator, self.value(b)?),
                }
            }
        }
    }

    fn constant(&self, value: &graph::Value) -> Option<Scalar> {
        match value {
            graph::Value::Bool(value) => Some(Scalar::Bool(*value)),
            graph::Value::Duration(time) => i128::try_from(time.as_nanos()).ok().map(Scalar::Integer),
            graph::Value::Number(number) => {
                let number = self.ty.measured_in().map_or_else(|| *number, |unit| number.in_unit(unit));
                match self.ty.is_integer() {
                    true => number.integer().map(Scalar::Integer),
                    false => Some(self.float(number.value)),
                }
            }
            _ => None,
        }
    }

    fn binary(&self, a: Scalar, operator: &str, b: Scalar) -> Option<Scalar> {
        match (a, b) {
            (Scalar::Integer(a), Scalar::Integer(b)) if graph::is_arithmetic(operator) => {
                self.integer(match operator {
                    "+" => a.checked_add(b),
                    "-" => a.checked_sub(b),
                    "*" => a.checked_mul(b),
                    "/" => a.checked_div(b),
                    _ => a.checked_rem(b),
                })
            }
            (Scalar::Float(a), Scalar::Float(b)) if graph::is_arithmetic(operator) => {
                Some(self.float(match operator {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    _ => a % b,
                }))
            }
            _ => Some(Scalar::Bool(match operator {
                "==" => a == b,
                "!=" => a != b,
                "<" => a < b,
                "<=" => a <= b,
                ">" => a > b,
                _ => a >= b,
            })),
        }
    }

    /// A computed integer, if the type has it in which tokens of this type are computed with.
    fn integer(&self, number: Option<i128>) -> Option<Scalar> {
        let fits = |number: &i128| self.ty.wide_bits() > 64 || i64::try_from(*number).is_ok();
        number.filter(fits).map(Scalar::Integer)
    }

    /// A number of the precision of the token.
    fn float(&self, number: f64) -> Scalar {
        let is_single = self.ty.without_unit().name() == "f32";
        Scalar::Float(if is_single { f64::from(number as f32) } else { number })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_dsl::{codegen::can_compute, graph::Number};
    use std::rc::Rc;

    fn token() -> Condition {
        Condition::Token
    }

    fn number(number: Number) -> Condition {
        Condition::Constant(graph::Value::Number(number))
    }

    fn whole(integer: i128) -> Condition {
        number(Number::whole(integer))
    }

    fn tenth() -> Condition {
        number(Number::whole(10).inverse().expect("not 0"))
    }

    fn binary(a: Condition, operator: &'static str, b: Condition) -> Condition {
        Condition::Binary(Box::new(a), operator, Box::new(b))
    }

    fn holds_for(token: impl std::any::Any, ty: &Type, condition: &Condition) -> bool {
        assert!(can_compute(condition, ty), "{ty}");
        let token: Value = Rc::new(token);
        holds(condition, &token, ty)
    }

    fn primitive(name: &str) -> Type {
        Type::Primitive(name.to_owned())
    }

    #[test]
    fn integers_are_computed_in_a_wide_type() {
        let sum = |limit| binary(binary(token(), "+", whole(100)), ">", whole(limit));
        assert!(holds_for(100_i8, &primitive("i8"), &sum(199)) && !holds_for(100_i8, &primitive("i8"), &sum(200)));
        assert!(holds_for(i64::MAX, &primitive("i64"), &sum(0)), "in 128 bits");
        let product = binary(binary(token(), "*", binary(token(), "*", token())), "<", whole(0));
        assert!(!holds_for(i32::MIN, &primitive("i32"), &product), "64 bits do not have the result");
        assert!(holds_for(i64::MIN / 10_000_000, &primitive("i64"), &product));
    }

    #[test]
    fn what_has_no_result_does_not_hold() {
        let quotient = binary(binary(whole(12), "/", token()), ">", whole(3));
        let not = Condition::Unary("!", Box::new(quotient.clone()));
        let u8 = primitive("u8");
        assert!(holds_for(3_u8, &u8, &quotient) && holds_for(4_u8, &u8, &not));
        assert!(!holds_for(0_u8, &u8, &quotient) && !holds_for(0_u8, &u8, &not));
        assert!(holds_for(0_u8, &u8, &binary(binary(token(), "==", whole(0)), "||", quotient)), "it is not reached");
    }

    #[test]
    fn floats_have_the_precision_of_the_token() {
        let equal = binary(token(), "==", tenth());
        assert!(holds_for(0.1_f32, &primitive("f32"), &equal) && holds_for(0.1_f64, &primitive("f64"), &equal));
        assert!(!holds_for(f64::from(0.1_f32), &primitive("f64"), &equal));
        let sum = binary(binary(token(), "+", tenth()), "==", Condition::Constant(graph::Value::Bool(true)));
        assert!(!holds_for(f64::NAN, &primitive("f64"), &sum));
        let not_equal = binary(token(), "!=", token());
        assert!(holds_for(f64::NAN, &primitive("f64"), &not_equal));
    }

    #[test]
    fn units_times_and_truth_values() {
        let centimetres = Type::Measured(Box::new(primitive("f64")), "cm".to_owned());
        assert!(holds_for(11.0_f64, &centimetres, &binary(token(), ">", tenth())));
        assert!(!holds_for(9.0_f64, &centimetres, &binary(token(), ">", tenth())));
        let second = || Condition::Constant(graph::Value::Duration(Duration::from_secs(1)));
        let later = binary(token(), ">", second());
        let time = Type::Named("apex_rt::Time".to_owned(), vec![]);
        let duration = Type::Named("core::time::Duration".to_owned(), vec![]);
        assert!(holds_for(Time::from_millis(1001), &time, &later) && !holds_for(Time::from_secs(1), &time, &later));
        assert!(holds_for(Duration::from_millis(1001), &duration, &later));
        let bool = primitive("bool");
        assert!(holds_for(true, &bool, &token()) && !holds_for(false, &bool, &token()));
    }
}
