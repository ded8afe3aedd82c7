use rxing::BarcodeFormat;

/// Supported kinds of bar codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Symbology {
    /// Code 128.
    Code128,
    /// Code 39.
    Code39,
    /// EAN-13. UPC-A is an EAN-13 that begins with 0.
    Ean13,
    /// EAN-8.
    Ean8,
    /// Interleaved two of five.
    Itf,
}

impl Symbology {
    /// All of them, as the decoder names them.
    pub(super) const ALL: [(BarcodeFormat, Self); 5] = [
        (BarcodeFormat::CODE_128, Self::Code128),
        (BarcodeFormat::CODE_39, Self::Code39),
        (BarcodeFormat::EAN_13, Self::Ean13),
        (BarcodeFormat::EAN_8, Self::Ean8),
        (BarcodeFormat::ITF, Self::Itf),
    ];

    /// Symbology of a format of the decoder, if it is one of them.
    pub(super) fn of(format: BarcodeFormat) -> Option<Self> {
        Self::ALL.iter().find(|(f, _)| *f == format).map(|(_, symbology)| *symbology)
    }
}
