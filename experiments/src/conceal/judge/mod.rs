//! The judge: scores a diagnosis of a concealed case after its seal is opened.
//! It reads a diagnosis as a file of documented keys and never calls the program that writes it.

pub mod intervals;
pub mod rules;
pub mod said;
pub mod score;
