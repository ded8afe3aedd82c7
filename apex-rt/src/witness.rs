//! Traits through which generated code asks what only rustc knows, so that its answer is a message of the compiler.

/// Declares such a trait. It has an attribute with the message, and its implementation one that keeps rustc from
/// looking behind it for another message.
#[doc(hidden)]
#[macro_export]
macro_rules! witness {
    // The token of an output is one that an input takes.
    (passes $(#[$message:meta])* $name:ident $(#[$silent:meta])*) => {
        $(#[$message])*
        trait $name<T: ?Sized> {
            fn pass(&self) -> &T;
        }
        impl<T: ?Sized> $name<T> for T {
            #[inline(always)]
            fn pass(&self) -> &T {
                self
            }
        }
    };
    // A delay has a first token.
    (starts $(#[$message:meta])* $name:ident $(#[$silent:meta])*) => {
        $(#[$message])*
        trait $name {
            fn first() -> Self;
        }
        $(#[$silent])*
        impl<T: ::core::default::Default> $name for T {
            fn first() -> Self {
                ::core::default::Default::default()
            }
        }
    };
    // Tokens can be copied.
    (copies $(#[$message:meta])* $name:ident $(#[$silent:meta])*) => {
        $(#[$message])*
        trait $name: ::core::marker::Sized {
            fn copied(&self) -> Self;
            fn store(place: &mut ::core::option::Option<Self>, token: ::core::option::Option<&Self>);
        }
        $(#[$silent])*
        impl<T: ::core::clone::Clone> $name for T {
            #[inline(always)]
            fn copied(&self) -> Self {
                ::core::clone::Clone::clone(self)
            }
            #[inline(always)]
            fn store(place: &mut ::core::option::Option<Self>, token: ::core::option::Option<&Self>) {
                $crate::store(place, token)
            }
        }
    };
    // A node can be made from its parameters.
    (makes $(#[$message:meta])* $name:ident $(#[$silent:meta])*) => {
        $(#[$message])*
        trait $name<P>: ::core::marker::Sized {
            fn made(params: P) -> Self;
        }
        $(#[$silent])*
        impl<P, N: $crate::Construct<P>> $name<P> for N {
            #[inline(always)]
            fn made(params: P) -> Self {
                <N as $crate::Construct<P>>::construct(params)
            }
        }
    };
    // A value is of the type of its parameter.
    (fits $(#[$message:meta])* $name:ident $(#[$silent:meta])*) => {
        $(#[$message])*
        trait $name<T> {
            fn fitting(self) -> T;
        }
        impl<T> $name<T> for T {
            #[inline(always)]
            fn fitting(self) -> T {
                self
            }
        }
    };
    // A type has a trait.
    (has $bound:path, $(#[$message:meta])* $name:ident $(#[$silent:meta])*) => {
        $(#[$message])*
        trait $name {}
        $(#[$silent])*
        impl<T: $bound> $name for T {}
    };
}
