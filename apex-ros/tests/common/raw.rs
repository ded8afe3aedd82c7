//! Messages of which the bytes are compared.

use apex_messages::{
    Message, Reason,
    cdr::{Reader, Writer},
};
use std::marker::PhantomData;

/// Bytes of a message, with its name: floats that are not numbers can be compared.
pub struct Raw<M>(pub Vec<u8>, PhantomData<fn() -> M>);

impl<M: Message> Raw<M> {
    pub fn of(message: &M) -> Self {
        Self(message.to_bytes(), PhantomData)
    }
}

impl<M: Message> Message for Raw<M> {
    const NAME: &'static str = M::NAME;
    const DEFINITION: &'static str = M::DEFINITION;
    const HASH: &'static str = M::HASH;

    fn write(&self, message: &mut Writer<'_>) {
        M::from_bytes(&self.0).expect("its own bytes").write(message);
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        M::read(message).map(|message| Self::of(&message))
    }
}
