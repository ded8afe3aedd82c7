//! Tracing of a type: it is read again and again from made-up values, each time another variant, until everything that
//! it asks for has been seen.

use super::parts::{Shape, Slot};
use serde::{
    Deserializer,
    de::{
        self, DeserializeOwned, DeserializeSeed, EnumAccess, IntoDeserializer, MapAccess, SeqAccess, VariantAccess,
        Visitor,
    },
};
use std::{
    fmt::{self, Display},
    panic::{AssertUnwindSafe, catch_unwind},
};

/// Number of types of one name within each other, before the type is taken for one that contains itself.
const WITHIN: usize = 3;
/// Maximum number of parts.
const PARTS: usize = 20_000;
/// Maximum number of readings.
const READINGS: usize = 10_000;
/// Number of attempts before a choice is given up: with both made-up values, and once more.
const ATTEMPTS: u8 = 3;
/// Maximum length of a tuple whose elements may have different types.
const LONGEST_TUPLE: usize = 16;

/// Returns what is known about type `T`.
pub fn trace<T: DeserializeOwned>() -> Slot {
    let (mut root, mut trace, mut idle) = (Slot::default(), Trace::default(), 0);
    for _ in 0..READINGS {
        (trace.news, trace.blamed) = (0, false);
        trace.open.clear();
        let reader = Reader { slot: &mut root, trace: &mut trace };
        // A type may have a check of its own that panics.
        let _ = catch_unwind(AssertUnwindSafe(|| T::deserialize(reader).map(drop)));
        idle = if trace.news == 0 { idle + 1 } else { 0 };
        if root.known || idle > ATTEMPTS {
            break;
        }
        if idle > 0 {
            trace.ones = !trace.ones;
        }
    }
    root
}

/// State of the readings of a type.
#[derive(Default)]
struct Trace {
    /// Names of the types that are being read, each within the one before.
    open: Vec<&'static str>,
    /// Made-up numbers are 1 instead of 0: some types refuse 0.
    ones: bool,
    /// Number of facts that this reading has found.
    news: usize,
    /// `true` if this reading has failed, and the last choice before that was blamed.
    blamed: bool,
    /// Number of parts.
    parts: usize,
}

/// Reason why no value can be made.
#[derive(Debug, PartialEq)]
enum Refused {
    /// The type refuses a made-up value.
    Value,
    /// The type is within itself, or too large.
    Within,
}

impl Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("refused")
    }
}

impl std::error::Error for Refused {}

impl de::Error for Refused {
    fn custom<T: Display>(_: T) -> Self {
        Self::Value
    }
}

impl Trace {
    /// Sets the shape of a part that is read for the first time.
    fn learn(&mut self, slot: &mut Slot, parts: usize, shape: impl FnOnce() -> Shape) -> Result<(), Refused> {
        if matches!(slot.shape, Shape::Unknown) {
            self.parts += parts;
            if self.parts > PARTS {
                return Err(Refused::Within);
            }
            slot.shape = shape();
            self.news += 1;
        }
        Ok(())
    }

    /// Begins to read a type with a name.
    fn enter(&mut self, name: &'static str, slot: &mut Slot) -> Result<(), Refused> {
        if !name.is_empty() && self.open.iter().filter(|open| **open == name).count() >= WITHIN {
            self.learn(slot, 1, || Shape::Leaf(name))?;
            slot.known = true;
            return Err(Refused::Within);
        }
        self.open.push(name);
        Ok(())
    }

    fn leave(&mut self) {
        self.open.pop();
    }

    /// Reads a part that can be left out, or replaced by another one. If that fails several times and nothing new is
    /// found, the part is given up.
    fn attempt<T>(
        &mut self,
        slot: &mut Slot,
        read: impl FnOnce(&mut Slot, &mut Self) -> Result<T, Refused>,
    ) -> Result<T, Refused> {
        let news = self.news;
        let result = read(slot, self);
        let Err(reason) = &result else { return result };
        if !self.blamed && (self.news == news || *reason == Refused::Within) {
            self.blamed = true;
            slot.failures += 1;
            if slot.failures >= ATTEMPTS || *reason == Refused::Within {
                slot.refused = true;
                self.news += 1;
            }
        }
        result
    }
}

/// Reader of a part of a type, from made-up values.
struct Reader<'a> {
    slot: &'a mut Slot,
    trace: &'a mut Trace,
}

impl Reader<'_> {
    fn leaf(&mut self, name: &'static str) -> Result<(), Refused> {
        self.trace.learn(self.slot, 1, || Shape::Leaf(name))?;
        self.slot.known = true;
        Ok(())
    }

    /// Reads values one after the other.
    fn values<'de, V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        count: usize,
        visit: impl FnOnce(Values<'_>) -> Result<V::Value, Refused>,
    ) -> Result<V::Value, Refused> {
        let Self { slot, trace } = self;
        trace.enter(name, slot)?;
        let parts = if name.is_empty() && count > LONGEST_TUPLE { 1 } else { count };
        let slots = || (0..parts).map(|_| Slot::default()).collect();
        trace.learn(slot, 1 + parts, || Shape::Values { name, fields, slots: slots(), count })?;
        let Shape::Values { slots, .. } = &mut slot.shape else { return Err(Refused::Value) };
        let result = visit(Values { slots, at: 0, count, trace });
        trace.leave();
        slot.known = slots.iter().all(Slot::is_closed);
        result
    }
}

macro_rules! leaves {
    ($($method:ident $visit:ident $name:literal $zero:expr, $one:expr;)*) => { $(
        fn $method<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Refused> {
            self.leaf($name)?;
            visitor.$visit(if self.trace.ones { $one } else { $zero })
        }
    )* };
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = Refused;

    leaves! {
        deserialize_bool visit_bool "bool" false, true;
        deserialize_i8 visit_i8 "i8" 0, 1;
        deserialize_i16 visit_i16 "i16" 0, 1;
        deserialize_i32 visit_i32 "i32" 0, 1;
        deserialize_i64 visit_i64 "i64" 0, 1;
        deserialize_i128 visit_i128 "i128" 0, 1;
        deserialize_u8 visit_u8 "u8" 0, 1;
        deserialize_u16 visit_u16 "u16" 0, 1;
        deserialize_u32 visit_u32 "u32" 0, 1;
        deserialize_u64 visit_u64 "u64" 0, 1;
        deserialize_u128 visit_u128 "u128" 0, 1;
        deserialize_f32 visit_f32 "f32" 0.0, 1.0;
        deserialize_f64 visit_f64 "f64" 0.0, 1.0;
        deserialize_char visit_char "char" '0', '1';
        deserialize_str visit_str "text" "", "1";
        deserialize_string visit_str "text" "", "1";
        deserialize_bytes visit_bytes "bytes" &[], &[1];
        deserialize_byte_buf visit_bytes "bytes" &[], &[1];
    }

    fn deserialize_unit<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Refused> {
        self.leaf("()")?;
        visitor.visit_unit()
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refused> {
        let Self { slot, trace } = self;
        trace.learn(slot, 2, || Shape::Option(Box::default()))?;
        let Shape::Option(inner) = &mut slot.shape else { return Err(Refused::Value) };
        if inner.is_closed() {
            slot.known = true;
            return visitor.visit_none();
        }
        let result = trace.attempt(inner, |slot, trace| visitor.visit_some(Reader { slot, trace }));
        slot.known = inner.is_closed();
        result
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, Refused> {
        self.values::<V>(name, &[], 0, |_| visitor.visit_unit())
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, Refused> {
        self.values::<V>(name, &[], 1, |mut values| match values.reader() {
            Some(reader) => visitor.visit_newtype_struct(reader),
            None => Err(Refused::Value),
        })
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refused> {
        let Self { slot, trace } = self;
        trace.learn(slot, 2, || Shape::List(Box::default()))?;
        let Shape::List(inner) = &mut slot.shape else { return Err(Refused::Value) };
        let count = usize::from(!inner.is_closed());
        let result = match count {
            0 => visitor.visit_seq(Values { slots: &mut [], at: 0, count, trace }),
            _ => trace.attempt(inner, |slot, trace| {
                visitor.visit_seq(Values { slots: std::slice::from_mut(slot), at: 0, count, trace })
            }),
        };
        slot.known = inner.is_closed();
        result
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value, Refused> {
        self.values::<V>("", &[], len, |values| visitor.visit_seq(values))
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        len: usize,
        visitor: V,
    ) -> Result<V::Value, Refused> {
        self.values::<V>(name, &[], len, |values| visitor.visit_seq(values))
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refused> {
        let Self { slot, trace } = self;
        trace.learn(slot, 3, || Shape::Map(Box::default()))?;
        let Shape::Map(slots) = &mut slot.shape else { return Err(Refused::Value) };
        let count = if slots.iter().all(Slot::is_closed) { 0 } else { 2 };
        let [key, value] = &mut **slots;
        // The value is what an entry is left out for.
        let result = match count {
            0 => visitor.visit_map(Entry { key, value: None, trace }),
            _ => trace.attempt(value, |value, trace| visitor.visit_map(Entry { key, value: Some(value), trace })),
        };
        key.refused |= value.refused;
        slot.known = slots.iter().all(Slot::is_closed);
        result
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refused> {
        self.values::<V>(name, fields, fields.len(), |values| visitor.visit_seq(values))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refused> {
        let Self { slot, trace } = self;
        trace.enter(name, slot)?;
        let slots = || variants.iter().map(|_| Slot::default()).collect();
        trace.learn(slot, 1 + variants.len(), || Shape::Enum { name, variants, slots: slots(), works: None })?;
        let Shape::Enum { slots, works, .. } = &mut slot.shape else { return Err(Refused::Value) };
        let next = slots.iter().position(|slot| !slot.is_closed()).or(*works);
        let result = match next.and_then(|number| Some((number, slots.get_mut(number)?))) {
            Some((number, variant)) => {
                let variant_name = variants[number];
                trace.attempt(variant, |slot, trace| {
                    visitor.visit_enum(Variant { number: number as u32, name: variant_name, slot, trace })
                })
            }
            None => Err(Refused::Value),
        };
        trace.leave();
        if result.is_ok() {
            *works = next;
        }
        slot.known = slots.iter().all(Slot::is_closed);
        result
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Refused> {
        Err(Refused::Value)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Refused> {
        Err(Refused::Value)
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Refused> {
        Err(Refused::Value)
    }

    fn is_human_readable(&self) -> bool {
        false
    }
}

/// Values one after the other. If there are fewer slots than values, the last one is that of all others.
struct Values<'a> {
    slots: &'a mut [Slot],
    at: usize,
    count: usize,
    trace: &'a mut Trace,
}

impl Values<'_> {
    fn reader(&mut self) -> Option<Reader<'_>> {
        let last = self.slots.len().checked_sub(1)?;
        let slot = self.slots.get_mut(self.at.min(last))?;
        self.at += 1;
        Some(Reader { slot, trace: self.trace })
    }
}

impl<'de> SeqAccess<'de> for Values<'_> {
    type Error = Refused;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Refused> {
        if self.at >= self.count {
            return Ok(None);
        }
        self.reader().map(|reader| seed.deserialize(reader)).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.count - self.at.min(self.count))
    }
}

/// The entries of a map: one, or none without a value.
struct Entry<'a> {
    key: &'a mut Slot,
    value: Option<&'a mut Slot>,
    trace: &'a mut Trace,
}

impl<'de> MapAccess<'de> for Entry<'_> {
    type Error = Refused;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Refused> {
        let reader = Reader { slot: self.key, trace: self.trace };
        self.value.as_ref().map(|_| seed.deserialize(reader)).transpose()
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, Refused> {
        let slot = self.value.take().ok_or(Refused::Value)?;
        seed.deserialize(Reader { slot, trace: self.trace })
    }
}

/// A variant of an enum.
struct Variant<'a> {
    number: u32,
    name: &'static str,
    slot: &'a mut Slot,
    trace: &'a mut Trace,
}

impl<'a, 'de> EnumAccess<'de> for Variant<'a> {
    type Error = Refused;
    type Variant = Self;

    fn variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<(T::Value, Self), Refused> {
        let number: de::value::U32Deserializer<Refused> = self.number.into_deserializer();
        Ok((seed.deserialize(number)?, self))
    }
}

impl<'de> VariantAccess<'de> for Variant<'_> {
    type Error = Refused;

    fn unit_variant(self) -> Result<(), Refused> {
        Reader { slot: self.slot, trace: self.trace }.leaf("()")
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Refused> {
        seed.deserialize(Reader { slot: self.slot, trace: self.trace })
    }

    fn tuple_variant<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value, Refused> {
        let reader = Reader { slot: self.slot, trace: self.trace };
        reader.values::<V>("", &[], len, |values| visitor.visit_seq(values))
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Refused> {
        let reader = Reader { slot: self.slot, trace: self.trace };
        reader.values::<V>(self.name, fields, fields.len(), |values| visitor.visit_seq(values))
    }
}
