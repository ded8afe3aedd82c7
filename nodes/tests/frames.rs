//! `frames.afg`: the tests of the source file.

use apex_rt::prelude::*;

apex_macros::graph!("frames.afg");

/// Time of a question.
#[node]
pub fn stamp(ctx: &Ctx, _question: &()) -> Time {
    ctx.stamp()
}
