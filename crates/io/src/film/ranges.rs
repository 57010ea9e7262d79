use std::fmt;
use std::ops::Range;

/// A set of sample indices: sorted, disjoint half-open ranges with gaps between them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct IndexRanges(Vec<Range<u64>>);

impl IndexRanges {
    /// No indices.
    pub fn new() -> Self {
        Self::default()
    }

    /// The ranges, in order.
    pub fn as_slice(&self) -> &[Range<u64>] {
        &self.0
    }

    /// Whether there is no index in it.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Number of indices.
    pub fn count(&self) -> u64 {
        // Disjoint parts of 0..2^64 − 1: the sum cannot overflow.
        self.0.iter().map(|r| r.end.saturating_sub(r.start)).fold(0, u64::saturating_add)
    }

    /// Number of indices that are `rest` modulo `modulus`: those that a film adds to that replicate.
    pub fn count_of_replicate(&self, rest: u32, modulus: u32) -> u64 {
        let (rest, modulus) = (u64::from(rest), u64::from(modulus.max(1)));
        // Indices below `end` with that rest: the quotient's whole turns and perhaps one more.
        let below = |end: u64| {
            let turns = end.checked_div(modulus).unwrap_or(0);
            turns.saturating_add(u64::from(end.checked_rem(modulus).unwrap_or(0) > rest))
        };
        self.0.iter().map(|r| below(r.end).saturating_sub(below(r.start))).fold(0, u64::saturating_add)
    }

    /// Whether an index is in it.
    pub fn contains(&self, index: u64) -> bool {
        let behind = self.0.partition_point(|r| r.end <= index);
        self.0.get(behind).is_some_and(|r| r.contains(&index))
    }

    /// Adds a range; an empty one adds nothing.
    pub fn insert(&mut self, range: Range<u64>) {
        self.extend(&Self(vec![range]));
    }

    /// Adds a range that lies behind all others, with a gap: what the caller has made sure of.
    pub(super) fn push_last(&mut self, range: Range<u64>) {
        self.0.push(range);
    }

    /// Adds all ranges of another set.
    pub fn extend(&mut self, other: &Self) {
        let mut all = std::mem::take(&mut self.0);
        all.extend(other.0.iter().filter(|r| !r.is_empty()).cloned());
        all.sort_by_key(|r| r.start);
        for r in all {
            match self.0.last_mut() {
                Some(last) if r.start <= last.end => last.end = last.end.max(r.end),
                _ => self.0.push(r),
            }
        }
    }

    /// The first range that both have; `None` where they have nothing in common.
    pub fn overlap(&self, other: &Self) -> Option<Range<u64>> {
        let (mut mine, mut theirs) = (self.0.iter().peekable(), other.0.iter().peekable());
        while let (Some(a), Some(b)) = (mine.peek(), theirs.peek()) {
            let both = a.start.max(b.start)..a.end.min(b.end);
            if !both.is_empty() {
                return Some(both);
            }
            if a.end <= b.end {
                mine.next()
            } else {
                theirs.next()
            };
        }
        None
    }

    /// What is missing of `whole`, in order.
    pub fn missing(&self, whole: Range<u64>) -> Vec<Range<u64>> {
        let mut out = Vec::new();
        let mut at = whole.start;
        for r in self.0.iter().filter(|r| r.end > whole.start && r.start < whole.end) {
            if r.start > at {
                out.push(at..r.start);
            }
            at = at.max(r.end);
        }
        if at < whole.end {
            out.push(at..whole.end);
        }
        out
    }
}

impl From<Range<u64>> for IndexRanges {
    fn from(range: Range<u64>) -> Self {
        let mut out = Self::new();
        out.insert(range);
        out
    }
}

impl fmt::Display for IndexRanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("none");
        }
        for (i, r) in self.0.iter().enumerate() {
            write!(f, "{}{}..{}", if i == 0 { "" } else { ", " }, r.start, r.end)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(ranges: &[Range<u64>]) -> IndexRanges {
        let mut out = IndexRanges::new();
        ranges.iter().for_each(|r| out.insert(r.clone()));
        out
    }

    #[test]
    fn ranges_are_sorted_and_joined() {
        let s = set(&[8..12, 0..4, 3..5, 20..20, 12..13]);
        assert_eq!(s.as_slice(), [0..5, 8..13]);
        assert_eq!(s.to_string(), "0..5, 8..13");
        assert_eq!((s.count(), s.contains(4), s.contains(5), s.is_empty()), (10, true, false, false));
        assert_eq!(set(&[]).to_string(), "none");
        assert_eq!(IndexRanges::from(0..u64::MAX).count(), u64::MAX);
    }

    #[test]
    fn overlaps_and_gaps() {
        let s = set(&[2..4, 8..10]);
        assert_eq!(s.overlap(&set(&[4..8, 9..20])), Some(9..10));
        assert_eq!(s.overlap(&set(&[0..2, 4..8, 10..11])), None);
        assert_eq!(s.missing(0..12), [0..2, 4..8, 10..12]);
        assert_eq!(s.missing(3..9), vec![4..8]);
        assert_eq!(s.missing(2..4), Vec::<Range<u64>>::new());
        assert_eq!(set(&[]).missing(1..3), vec![1..3]);
    }

    #[test]
    fn replicates_share_the_indices_by_their_rest() {
        let s = set(&[1..6, 9..10]);
        // 1 2 3 4 5 9 modulo 3.
        assert_eq!([0, 1, 2].map(|k| s.count_of_replicate(k, 3)), [2, 2, 2]);
        assert_eq!(s.count_of_replicate(0, 1), 6);
        assert_eq!([0, 1].map(|k| s.count_of_replicate(k, 2)), [2, 4]);
    }
}
