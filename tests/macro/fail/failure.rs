//! An error without a text.
use apex_rt::prelude::*;

pub struct Silent;

#[node]
fn parse(x: &u64) -> Result<u64, Silent> {
    let _ = x;
    Err(Silent)
}

/// Of its slot, too.
pub struct Door<T> {
    value: Option<T>,
}

#[node]
impl<T: Clone> Door<T> {
    #[slot]
    fn put(&mut self, value: &T) -> Result<(), Option<T>> {
        self.value = Some(value.clone());
        Err(None)
    }
}

fn main() {}
