//! The words of the report in every language: one table, [`messages`].

mod messages;

use std::str::FromStr;

use messages::{MESSAGES, Message};

/// Languages of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// Simplified Chinese.
    Chinese,
}

impl Language {
    /// All languages, with the codes that users write.
    pub const ALL: [(&'static str, Language); 2] =
        [("en", Language::English), ("zh", Language::Chinese)];

    /// The code that users write: `en` or `zh`.
    pub fn code(self) -> &'static str {
        let found = Language::ALL.iter().find(|(_, language)| *language == self);
        found.map_or("en", |(code, _)| code)
    }

    /// The code for HTML.
    pub(crate) fn tag(self) -> &'static str {
        match self {
            Language::English => "en",
            Language::Chinese => "zh-CN",
        }
    }

    /// The text of a message; `None` for a key that the table does not have.
    pub(crate) fn find(self, key: &str) -> Option<&'static str> {
        let message = MESSAGES.iter().find(|message| message.key == key)?;
        Some(message.text(self))
    }

    /// The text of a message. A test holds that every key in the sources is in the table; one that
    /// is not stands for itself.
    pub(crate) fn text(self, key: &str) -> &str {
        self.find(key).unwrap_or(key)
    }

    /// The text of a message with values in the places of their names in braces.
    pub(crate) fn fill(self, key: &str, values: &[(&str, &str)]) -> String {
        let mut filled = String::new();
        let mut rest = self.text(key);
        // Values may hold braces of their own, so that every text is gone through once.
        while let Some((before, after)) = rest.split_once('{') {
            filled.push_str(before);
            let Some((name, behind)) = after.split_once('}') else {
                filled.push('{');
                rest = after;
                continue;
            };
            match values.iter().find(|(known, _)| *known == name) {
                Some((_, value)) => filled.push_str(value),
                None => filled.push_str(&format!("{{{name}}}")),
            }
            rest = behind;
        }
        filled.push_str(rest);
        filled
    }

    /// Several texts as a list in a sentence.
    pub(crate) fn list(self, items: &[String]) -> String {
        items.join(self.text("list.separator"))
    }

    /// A channel in words: `hose.end_b.force_x` is "hose, end B, force x".
    pub(crate) fn channel(self, channel: &str) -> String {
        let (object, quantity) = channel.rsplit_once('.').unwrap_or(("", channel));
        // A place along a line may hold a point: `hose.effective_tension@12.5 m`.
        let (object, quantity) = match channel.rsplit_once('@') {
            Some((before, place)) => {
                let (object, quantity) = before.rsplit_once('.').unwrap_or(("", before));
                let quantity = self.quantity(quantity);
                let place = spaced(place);
                (
                    object,
                    self.fill("channel.at", &[("quantity", &quantity), ("place", &place)]),
                )
            }
            None => (object, self.quantity(quantity)),
        };
        let (name, end) = match object.rsplit_once('.') {
            Some((name, "end_a")) => (name, Some("end_a")),
            Some((name, "end_b")) => (name, Some("end_b")),
            _ if object == "end_a" || object == "end_b" => ("", Some(object)),
            _ => (object, None),
        };
        let mut words: Vec<String> = Vec::new();
        if !name.is_empty() {
            words.push(name.to_owned());
        }
        words.extend(end.map(|end| self.end(end)));
        words.push(quantity);
        words.join(self.text("channel.separator"))
    }

    /// An end of a line: `end_a` or `end_b`.
    pub(crate) fn end(self, end: &str) -> String {
        let key = if end == "end_a" { "end.a" } else { "end.b" };
        self.text(key).to_owned()
    }

    /// A quantity of a channel in words.
    pub(crate) fn quantity(self, quantity: &str) -> String {
        let known = self.find(&format!("quantity.{quantity}"));
        known.map_or_else(|| quantity.replace('_', " "), str::to_owned)
    }

    /// Every character that the messages of the language use.
    #[cfg(test)]
    pub(crate) fn characters(self) -> std::collections::BTreeSet<char> {
        let texts = MESSAGES.iter().map(|message| message.text(self));
        texts.flat_map(str::chars).collect()
    }
}

/// A number and its unit with a space between: `225m` is "225 m".
fn spaced(place: &str) -> String {
    match place.find(|c: char| c.is_alphabetic()) {
        Some(unit) => format!("{} {}", place[..unit].trim_end(), &place[unit..]),
        None => place.to_owned(),
    }
}

impl FromStr for Language {
    type Err = String;

    fn from_str(code: &str) -> Result<Self, String> {
        let found = Language::ALL.iter().find(|(known, _)| *known == code);
        found
            .map(|(_, language)| *language)
            .ok_or_else(|| "write en or zh".to_owned())
    }
}

impl Message {
    fn text(&self, language: Language) -> &'static str {
        match language {
            Language::English => self.english,
            Language::Chinese => self.chinese,
        }
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
