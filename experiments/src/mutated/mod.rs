//! Damaged studies through every command: what must be refused, what must not change the answer, and what may change it and must be reported.
//! A sound study is changed in one way after the other, each change with a seed of its own; no recording of a real ship is used.

pub mod answer;
pub mod damage;
pub mod edit;
pub mod fate;
pub mod files;
pub mod logger;
pub mod plan;
pub mod row;
pub mod runner;
pub mod summary;
