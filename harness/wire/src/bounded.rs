//! Numbers that only exist inside their limits.

/// Defines a number type with a lowest and a highest value, a checked constructor and `raw`.
macro_rules! bounded {
    ($(#[$doc:meta])* pub struct $name:ident($raw:ty) in $lowest:literal..=$highest:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name($raw);

        impl $name {
            /// The lowest value.
            pub const MIN: $name = $name($lowest);
            /// The highest value.
            pub const MAX: $name = $name($highest);

            /// The value `raw`, if it lies between [`Self::MIN`] and [`Self::MAX`].
            pub const fn new(raw: $raw) -> Option<$name> {
                match raw {
                    $lowest..=$highest => Some($name(raw)),
                    _ => None,
                }
            }

            /// The value as a number.
            pub const fn raw(self) -> $raw {
                self.0
            }

            /// The value `raw` found at byte `offset`.
            #[allow(dead_code, reason = "not every number is read from bytes")]
            pub(crate) fn parse(raw: $raw, offset: usize) -> Result<$name, $crate::Violation> {
                $name::new(raw).ok_or_else(|| {
                    $crate::Violation::range(offset, u64::from(raw), $lowest, $highest)
                })
            }
        }
    };
}
