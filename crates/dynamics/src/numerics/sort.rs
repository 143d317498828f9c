//! Sorting by a comparison.

use core::cmp::Ordering;

/// Sorts by a comparison; what is equal keeps its order.
///
/// As `slice::sort_by`, but with one copy of the sort for all types: one for each of them took a
/// thirtieth of the page's module.
pub fn sort<T>(all: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    let mut from: Vec<usize> = (0..all.len()).collect();
    sort_numbers(&mut from, &|i, j| compare(&all[i], &all[j]));
    let mut to = vec![0; all.len()];
    for (i, &from) in from.iter().enumerate() {
        to[from] = i;
    }
    // Each exchange puts one into its place.
    for i in 0..all.len() {
        while to[i] != i {
            let place = to[i];
            all.swap(i, place);
            to.swap(i, place);
        }
    }
}

fn sort_numbers(numbers: &mut [usize], compare: &dyn Fn(usize, usize) -> Ordering) {
    numbers.sort_by(|i, j| compare(*i, *j));
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn prop_it_sorts_as_the_standard_library(keys in prop::collection::vec(0..9_u8, 0..60)) {
            let mut all: Vec<(u8, usize)> = keys.into_iter().zip(0..).collect();
            let mut expected = all.clone();
            expected.sort_by_key(|a| a.0);
            super::sort(&mut all, |a, b| a.0.cmp(&b.0));
            prop_assert_eq!(all, expected);
        }
    }
}
