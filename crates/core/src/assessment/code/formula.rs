//! Formulas of the files of codes: numbers, names, `+ - * / ^`, parentheses and calls.

/// A formula, read once.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Formula {
    /// A number.
    Number(f64),
    /// A quantity by its name.
    Name(String),
    /// A function of formulas.
    Call(String, Vec<Self>),
    /// Two formulas with a sign between them.
    Binary(char, Box<[Self; 2]>),
}

impl Formula {
    /// Reads a formula; else what is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut reader = Reader { text, at: 0 };
        let formula = reader.sum()?;
        match reader.peek() {
            None => Ok(formula),
            Some(found) => {
                Err(format!("expected an end after {:?}, found {found:?}", reader.read()))
            }
        }
    }

    /// Every name in it.
    pub fn names(&self) -> Vec<&str> {
        match self {
            Self::Number(_) => Vec::new(),
            Self::Name(name) => vec![name],
            Self::Call(_, of) => of.iter().flat_map(Self::names).collect(),
            Self::Binary(_, of) => of.iter().flat_map(Self::names).collect(),
        }
    }

    /// Every function in it, with the number of its arguments.
    pub fn calls(&self) -> Vec<(&str, usize)> {
        match self {
            Self::Number(_) | Self::Name(_) => Vec::new(),
            Self::Call(name, of) => {
                let own = core::iter::once((name.as_str(), of.len()));
                own.chain(of.iter().flat_map(Self::calls)).collect()
            }
            Self::Binary(_, of) => of.iter().flat_map(Self::calls).collect(),
        }
    }
}

/// What a sign makes of two numbers.
pub(super) fn combined(sign: char, a: f64, b: f64) -> f64 {
    match sign {
        '+' => a + b,
        '-' => a - b,
        '*' => a * b,
        '/' => a / b,
        _ => libm::pow(a, b),
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl Reader<'_> {
    /// What has been read.
    fn read(&self) -> &str {
        &self.text[..self.at]
    }

    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let is_there = self.peek() == Some(wanted);
        self.at += if is_there { wanted.len_utf8() } else { 0 };
        is_there
    }

    fn sum(&mut self) -> Result<Formula, String> {
        self.signed(&['+', '-'], Self::product)
    }

    fn product(&mut self) -> Result<Formula, String> {
        self.signed(&['*', '/'], Self::power)
    }

    /// Terms with these signs between them, from the left.
    fn signed(
        &mut self,
        signs: &[char],
        term: fn(&mut Self) -> Result<Formula, String>,
    ) -> Result<Formula, String> {
        let mut formula = term(self)?;
        while let Some(sign) = signs.iter().copied().find(|sign| self.take(*sign)) {
            formula = Formula::Binary(sign, Box::new([formula, term(self)?]));
        }
        Ok(formula)
    }

    fn power(&mut self) -> Result<Formula, String> {
        let base = self.term()?;
        if self.take('^') {
            return Ok(Formula::Binary('^', Box::new([base, self.power()?])));
        }
        Ok(base)
    }

    fn term(&mut self) -> Result<Formula, String> {
        if self.take('(') {
            let formula = self.sum()?;
            return if self.take(')') { Ok(formula) } else { Err(self.expected("a )")) };
        }
        let first = self.peek();
        let rest = &self.text[self.at..];
        let of = |fits: fn(char) -> bool| rest.find(|c| !fits(c)).unwrap_or(rest.len());
        let end = match first {
            Some(c) if c.is_ascii_digit() => of(|c| c.is_ascii_digit() || c == '.'),
            Some(c) if c.is_ascii_alphabetic() => of(|c| c.is_ascii_alphanumeric() || c == '_'),
            _ => return Err(self.expected("a number, a name or a (")),
        };
        let word = rest[..end].to_owned();
        self.at += end;
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            let number = word.parse().map(Formula::Number);
            return number.map_err(|_| format!("expected a number, found {word:?}"));
        }
        if !self.take('(') {
            return Ok(Formula::Name(word));
        }
        let mut of = Vec::new();
        while !self.take(')') {
            if !of.is_empty() && !self.take(',') {
                return Err(self.expected("a , or a )"));
            }
            of.push(self.sum()?);
        }
        Ok(Formula::Call(word, of))
    }

    fn expected(&mut self, what: &str) -> String {
        let found = self.peek().map_or("the end".to_owned(), |c| format!("{c:?}"));
        format!("expected {what} after {:?}, found {found}", self.read())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(formula: &Formula) -> f64 {
        match formula {
            Formula::Number(number) => *number,
            Formula::Binary(sign, of) => combined(*sign, value(&of[0]), value(&of[1])),
            _ => f64::NAN,
        }
    }

    #[test]
    fn signs_bind_as_on_paper() {
        for (text, expected) in [
            ("1 + 2*3 - 4/8", 6.5),
            ("(1 + 2)*3", 9.0),
            ("2^3^2", 512.0),
            ("12 - 3 - 2", 7.0),
            ("12/3/2", 2.0),
            ("2*3^2", 18.0),
            ("0.375", 0.375),
        ] {
            assert_eq!(value(&Formula::parse(text).unwrap()), expected, "{text}");
        }
        let named = Formula::parse("max(1.15, 1 + y/P_T^2*e)").unwrap();
        assert_eq!(named.names(), ["y", "P_T", "e"]);
        assert_eq!(named.calls(), [("max", 2)]);
    }

    #[test]
    fn what_is_no_formula_says_where() {
        for (text, expected) in [
            ("1 +", "expected a number, a name or a ( after \"1 +\", found the end"),
            ("(1", "expected a ) after \"(1\", found the end"),
            ("1 2", "expected an end after \"1 \", found '2'"),
            ("max(1 2)", "expected a , or a ) after \"max(1 \", found '2'"),
            ("1.2.3", "expected a number, found \"1.2.3\""),
            ("μ", "expected a number, a name or a ( after \"\", found 'μ'"),
        ] {
            assert_eq!(Formula::parse(text).unwrap_err(), expected);
        }
    }
}
