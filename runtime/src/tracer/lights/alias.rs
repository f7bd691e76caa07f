//! Choosing from a list by weight with two numbers: Walker, An Efficient Method for Generating Discrete
//! Random Variables with General Distributions, 1977, built as Vose 1991 does.

/// An entry: it stays below the threshold, else the alias is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    pub(super) threshold: f32,
    pub(super) alias: u32,
}

/// A table of `weights`, finite and not negative. Where all are 0, all are alike likely.
pub(super) fn table(weights: &[f64]) -> Vec<Choice> {
    let count = u32::try_from(weights.len()).unwrap_or(u32::MAX);
    let sum: f64 = weights.iter().sum();
    let mut table: Vec<Choice> = (0..count)
        .map(|alias| Choice {
            threshold: 1.0,
            alias,
        })
        .collect();
    if sum <= 0.0 {
        return table;
    }
    let scale = weights.len() as f64 / sum;
    let mut left: Vec<f64> = weights.iter().map(|weight| weight * scale).collect();
    let (mut small, mut large): (Vec<u32>, Vec<u32>) =
        (0..count).partition(|&index| left[index as usize] < 1.0);
    while let (Some(&low), Some(&high)) = (small.last(), large.last()) {
        small.pop();
        let (low, high_at) = (low as usize, high as usize);
        table[low] = Choice {
            threshold: super::single(left[low]),
            alias: high,
        };
        left[high_at] -= 1.0 - left[low];
        if left[high_at] < 1.0 {
            large.pop();
            small.push(high);
        }
    }
    // What is left over is 1 but for rounding; one that has no weight must not be chosen though.
    let heaviest = (0..count).max_by(|&a, &b| {
        let [a, b] = [a, b].map(|index| weights[index as usize]);
        a.total_cmp(&b)
    });
    for low in small {
        if weights[low as usize] <= 0.0 {
            table[low as usize] = Choice {
                threshold: 0.0,
                alias: heaviest.unwrap_or(low),
            };
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How likely each entry is by the table.
    fn chances(table: &[Choice]) -> Vec<f64> {
        let mut chances = vec![0.0; table.len()];
        for (index, choice) in table.iter().enumerate() {
            chances[index] += f64::from(choice.threshold);
            chances[choice.alias as usize] += 1.0 - f64::from(choice.threshold);
        }
        chances.iter().map(|c| c / table.len() as f64).collect()
    }

    #[test]
    fn entries_are_as_likely_as_they_are_heavy() {
        let uneven: Vec<f64> = (0..1000).map(|i| f64::from(i % 97) * 0.013).collect();
        let steep: Vec<f64> = (0..60).map(|i| 0.5_f64.powi(i)).collect();
        for weights in [vec![2.0], vec![0.0, 3.0, 0.0], vec![1.0; 7], uneven, steep] {
            let sum: f64 = weights.iter().sum();
            for (chance, weight) in chances(&table(&weights)).iter().zip(&weights) {
                assert!((chance - weight / sum).abs() < 1.0e-6, "{weights:?}");
                assert!(*weight > 0.0 || *chance == 0.0, "no weight, and chosen");
            }
        }
        assert_eq!(chances(&table(&[0.0; 4])), [0.25; 4]);
    }
}
