/// Robust kernel ρ(χ²) of an edge: bounds the influence of measurements that contradict the others, such as false
/// loops.
///
/// A measurement whose χ² is below the square of the threshold counts as without a kernel. With
/// [`Cauchy`](Self::Cauchy) it counts a little less.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum RobustKernel {
    /// ρ = χ²: least squares.
    #[default]
    Square,
    /// Linear in the error above the threshold (Huber 1964): an outlier keeps a bounded pull.
    Huber(f64),
    /// Logarithmic (Cauchy): the pull of an outlier decreases with its error.
    Cauchy(f64),
    /// Dynamic covariance scaling with this Φ (Agarwal, Tipaldi, Spinello, Stachniss, Burgard: Robust Map Optimization
    /// Using Dynamic Covariance Scaling, 2013): the pull of an outlier vanishes. The threshold is √Φ.
    Dcs(f64),
}

impl RobustKernel {
    /// Cost ρ of a measurement with this χ².
    pub fn cost(self, chi2: f64) -> f64 {
        match self {
            Self::Square => chi2,
            Self::Huber(k) if chi2 <= k * k => chi2,
            Self::Huber(k) => 2.0 * k * chi2.sqrt() - k * k,
            Self::Cauchy(k) => k * k * (chi2 / (k * k)).ln_1p(),
            Self::Dcs(phi) if chi2 <= phi => chi2,
            Self::Dcs(phi) => phi * (3.0 * chi2 - phi) / (chi2 + phi),
        }
    }

    /// Derivative ρ′ of the cost: the factor of the information of a measurement with this χ².
    pub fn weight(self, chi2: f64) -> f64 {
        match self {
            Self::Square => 1.0,
            Self::Huber(k) => (k / chi2.sqrt()).min(1.0),
            Self::Cauchy(k) => 1.0 / (1.0 + chi2 / (k * k)),
            Self::Dcs(phi) => (2.0 * phi / (phi + chi2)).min(1.0).powi(2),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNELS: [RobustKernel; 4] =
        [RobustKernel::Square, RobustKernel::Huber(1.5), RobustKernel::Cauchy(1.5), RobustKernel::Dcs(2.0)];

    #[test]
    fn weights_are_the_derivatives_of_costs() {
        for kernel in KERNELS {
            for chi2 in [0.1, 1.0, 3.0, 50.0] {
                let h = 1e-6;
                let slope = (kernel.cost(chi2 + h) - kernel.cost(chi2 - h)) / (2.0 * h);
                assert!((slope - kernel.weight(chi2)).abs() < 1e-6, "{kernel:?} at {chi2}: {slope}");
            }
        }
    }

    #[test]
    fn exact_measurements_count_fully_and_cost_nothing() {
        for kernel in KERNELS {
            assert_eq!((kernel.cost(0.0), kernel.weight(0.0)), (0.0, 1.0), "{kernel:?}");
        }
    }
}
