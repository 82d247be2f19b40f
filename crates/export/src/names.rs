//! The names that a user asks for, against those that there are.

use crate::ExportError;

/// Most names that a message lists.
const MOST_LISTED: usize = 12;

/// Likeness from which on a name is taken for a slip of the pen (Jaro-Winkler, 1: equal).
const ALIKE: f64 = 0.75;

/// An error for the first name that is not among those that there are.
pub(crate) fn check(
    what: &'static str,
    asked: &[String],
    available: &[String],
) -> Result<(), ExportError> {
    match asked.iter().find(|name| !available.contains(name)) {
        None => Ok(()),
        Some(name) => Err(ExportError::UnknownName {
            what,
            name: name.clone(),
            suggestion: suggestion(name, available),
        }),
    }
}

fn suggestion(name: &str, available: &[String]) -> String {
    let mut alike: Vec<(f64, &String)> = available
        .iter()
        .map(|other| {
            let likeness = strsim::jaro_winkler(&name.to_lowercase(), &other.to_lowercase());
            (likeness, other)
        })
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .collect();
    alike.sort_by(|a, b| b.0.total_cmp(&a.0));
    if !alike.is_empty() {
        let names = alike.iter().take(3).map(|(_, name)| format!("`{name}`"));
        return format!("did you mean {}?", names.collect::<Vec<_>>().join(" or "));
    }
    let listed = available.iter().take(MOST_LISTED);
    let listed = listed.map(|name| format!("`{name}`")).collect::<Vec<_>>();
    match available.len() {
        0 => "it has none".to_owned(),
        n if n > MOST_LISTED => {
            format!("it has {} and {} more", listed.join(", "), n - MOST_LISTED)
        }
        _ => format!("it has {}", listed.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(asked: &str, available: &[&str]) -> String {
        let available: Vec<String> = available.iter().map(|&name| name.to_owned()).collect();
        check("line", &[asked.to_owned()], &available)
            .expect_err("unknown")
            .to_string()
    }

    #[test]
    fn a_slip_is_answered_with_the_nearest_name_and_anything_else_with_all() {
        assert!(message("hsoe", &["pipe", "hose"]).ends_with("did you mean `hose`?"));
        assert!(message("HOSE", &["pipe", "hose"]).ends_with("did you mean `hose`?"));
        assert!(message("xyz", &["pipe", "hose"]).ends_with("it has `pipe`, `hose`"));
        assert!(message("xyz", &[]).ends_with("it has none"));
        let many: Vec<String> = (0..20).map(|n| format!("{n}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert!(message("hose", &many).ends_with("`11` and 8 more"));
    }

    #[test]
    fn known_names_pass() {
        assert!(check("line", &["a".into()], &["a".into(), "b".into()]).is_ok());
        assert!(check("line", &[], &[]).is_ok());
    }
}
