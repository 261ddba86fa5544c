//! What stands in for MPI in a build without the feature `mpi`: no other rank can be reached, so that nothing is ever sent.
//! Its type has no value; the compiler sees that none of its methods is called.

/// A job of several ranks, which this build cannot join.
pub(super) enum World {}

impl World {
    pub fn join() -> Option<Self> {
        None
    }

    pub fn rank(&self) -> usize {
        match *self {}
    }

    pub fn size(&self) -> usize {
        match *self {}
    }

    pub fn sum(&self, _own: &[i64]) -> Vec<i64> {
        match *self {}
    }

    pub fn largest(&self, _own: &[i64]) -> Vec<i64> {
        match *self {}
    }

    pub fn gather(&self, _own: &[u8]) -> Vec<Vec<u8>> {
        match *self {}
    }

    pub fn hand_in(&self, _text: &[u8]) {
        match *self {}
    }

    pub fn handed_in(&self) -> Option<Vec<u8>> {
        match *self {}
    }

    pub fn abort(&self, _code: i32) -> ! {
        match *self {}
    }
}
