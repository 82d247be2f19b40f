//! The secret in the address: whoever has the link may look, nobody else.

use crate::ViewerError;

/// 128 random bits in hexadecimal.
pub(crate) fn random() -> Result<String, ViewerError> {
    let mut bytes = [0_u8; 16];
    getrandom::fill(&mut bytes).map_err(|error| ViewerError::Random {
        message: error.to_string(),
    })?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Compares without telling by the time taken how much of a guess is right.
pub(crate) fn matches(token: &str, guess: &str) -> bool {
    let pairs = token.bytes().zip(guess.bytes());
    token.len() == guess.len() && pairs.fold(0, |seen, (a, b)| seen | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_long_and_differ() {
        let (a, b) = (random().unwrap(), random().unwrap());
        assert_eq!(a.len(), 32);
        assert_ne!(a, b);
        assert!(matches(&a, &a) && !matches(&a, &b) && !matches(&a, "") && !matches("", "a"));
    }
}
