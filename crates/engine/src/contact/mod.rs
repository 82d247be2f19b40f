//! Contact with the flat seabed.

pub mod seabed;
