//! Results: names for what a node returns.

use super::emitter::Emitter;
use crate::{graph::PortId, program::Storage};
use proc_macro2::TokenStream;
use quote::quote;

impl Emitter<'_> {
    /// `let name = value;`, or the assignment to a name declared further out. What is there for certain is used
    /// by reference in the rest of its own block; not what a node that may be disabled sends.
    pub fn bind(&self, end: PortId, value: TokenStream, optional: bool) -> TokenStream {
        let name = self.generator.name(end);
        if self.plan.storage(end) == Storage::Array {
            return self.put_in_array(end, value, optional);
        }
        match (self.plan.is_hoisted(end), optional) {
            (false, _) => quote! { let #name = #value; },
            (true, true) => quote! { #name = #value; },
            (true, false) if self.plan.storage(end) == Storage::Local => quote! { let #name = &*#name.insert(#value); },
            (true, false) => quote! { #name = Some(#value); },
        }
    }
}
