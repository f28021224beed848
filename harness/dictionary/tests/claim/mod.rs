//! Arithmetic claims: `holds: 0x0FB4 = 4020; 4020 / 1000 = 4.020`, in exact fractions.

/// Whether a claim says what is so; why it cannot be read, if it cannot.
pub(crate) fn is_right(claim: &str) -> Result<bool, String> {
    let (said, clauses) = match (claim.strip_prefix("holds: "), claim.strip_prefix("fails: ")) {
        (Some(clauses), _) => (true, clauses),
        (_, Some(clauses)) => (false, clauses),
        _ => return Err(format!("`{claim}` neither holds nor fails")),
    };
    let mut all = true;
    for text in clauses.split(';') {
        all &= clause(text).ok_or_else(|| format!("`{text}` is no clause"))?;
    }
    Ok(all == said)
}

fn clause(text: &str) -> Option<bool> {
    for relation in ["<=", ">=", "~", "="] {
        if let Some((left, right)) = text.split_once(relation) {
            let (left, right) = (evaluate(left)?, evaluate(right)?);
            let difference = left.subtract(right)?;
            return Some(match relation {
                "<=" => difference.numerator <= 0,
                ">=" => difference.numerator >= 0,
                "=" => difference.numerator == 0,
                _ => difference.approximate().abs() <= 0.003 * right.approximate().abs(),
            });
        }
    }
    None
}

/// A fraction with a denominator over 0.
#[derive(Clone, Copy)]
struct Fraction {
    numerator: i128,
    denominator: i128,
}

impl Fraction {
    fn new(numerator: i128, denominator: i128) -> Option<Fraction> {
        let (mut divisor, mut rest) = (numerator.checked_abs()?, denominator.checked_abs()?);
        while rest != 0 {
            (divisor, rest) = (rest, divisor % rest);
        }
        let divisor = divisor * denominator.signum();
        (divisor != 0).then(|| Fraction {
            numerator: numerator / divisor,
            denominator: denominator / divisor,
        })
    }

    fn whole(value: i128) -> Option<Fraction> {
        Fraction::new(value, 1)
    }

    fn integer(self) -> Option<i128> {
        (self.denominator == 1).then_some(self.numerator)
    }

    fn approximate(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }

    fn subtract(self, other: Fraction) -> Option<Fraction> {
        let left = self.numerator.checked_mul(other.denominator)?;
        let right = other.numerator.checked_mul(self.denominator)?;
        Fraction::new(
            left.checked_sub(right)?,
            self.denominator.checked_mul(other.denominator)?,
        )
    }

    fn apply(self, operator: &str, other: Fraction) -> Option<Fraction> {
        match operator {
            "+" => self.subtract(Fraction::new(-other.numerator, other.denominator)?),
            "-" => self.subtract(other),
            "*" => Fraction::new(
                self.numerator.checked_mul(other.numerator)?,
                self.denominator.checked_mul(other.denominator)?,
            ),
            "/" => Fraction::new(
                self.numerator.checked_mul(other.denominator)?,
                self.denominator.checked_mul(other.numerator)?,
            ),
            "<<" => Fraction::whole(self.integer()? << u32::try_from(other.integer()?).ok()?),
            ">>" => Fraction::whole(self.integer()? >> u32::try_from(other.integer()?).ok()?),
            "&" => Fraction::whole(self.integer()? & other.integer()?),
            _ => None,
        }
    }
}

/// Operators from the loosest to the tightest.
const LEVELS: [&[&str]; 4] = [&["&"], &["<<", ">>"], &["+", "-"], &["*", "/"]];

fn evaluate(text: &str) -> Option<Fraction> {
    let spaced = text.replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = words.as_slice();
    let value = level(&mut rest, 0)?;
    rest.is_empty().then_some(value)
}

fn level(words: &mut &[&str], depth: usize) -> Option<Fraction> {
    let Some(operators) = LEVELS.get(depth) else {
        return term(words);
    };
    let mut value = level(words, depth + 1)?;
    while let [operator, rest @ ..] = *words {
        if !operators.contains(operator) {
            break;
        }
        *words = rest;
        value = value.apply(operator, level(words, depth + 1)?)?;
    }
    Some(value)
}

fn term(words: &mut &[&str]) -> Option<Fraction> {
    let (first, rest) = words.split_first()?;
    *words = rest;
    if *first != "(" {
        return number(first);
    }
    let value = level(words, 0)?;
    let (last, rest) = words.split_first()?;
    *words = rest;
    (*last == ")").then_some(value)
}

fn number(word: &str) -> Option<Fraction> {
    if let Some(digits) = word.strip_prefix("0x") {
        return Fraction::whole(i128::from_str_radix(digits, 16).ok()?);
    }
    if let Some(digits) = word.strip_prefix("0b") {
        return Fraction::whole(i128::from_str_radix(digits, 2).ok()?);
    }
    let (whole, places) = word.split_once('.').unwrap_or((word, ""));
    let digits = format!("{whole}{places}").parse().ok()?;
    Fraction::new(digits, 10_i128.pow(u32::try_from(places.len()).ok()?))
}

#[test]
fn claims_are_computed() {
    for right in [
        "holds: 1 + 2 * 3 = 7; (1 + 2) * 3 = 9",
        "holds: 0x10 >> 2 & 6 = 4; 7 - 2 - 1 = 4; 8 / 4 / 2 = 1",
        "holds: -36.2115 = (0xFFDC - 0x10000) + (0xF7BD - 0x10000) / 10000",
        "holds: 0b101 = 5; 1000 ~ 1002; 3 <= 4; 4 >= 4",
        "fails: 1 = 1; 1 = 2",
        "fails: 1000 ~ 1004",
    ] {
        assert_eq!(is_right(right), Ok(true), "{right}");
    }
    for wrong in [
        "holds: 1 = 2",
        "fails: 2 = 2",
        "holds: 4 <= 3",
        "holds: 3 >= 4",
    ] {
        assert_eq!(is_right(wrong), Ok(false), "{wrong}");
    }
    for unreadable in [
        "1 = 1",
        "holds: 1",
        "holds: 1 + = 2",
        "holds: (1 = 1",
        "holds: 1 / 0 = 1",
        "holds: x = 1",
    ] {
        assert!(is_right(unreadable).is_err(), "{unreadable}");
    }
}
