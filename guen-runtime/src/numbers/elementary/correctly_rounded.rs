//! Operations that the platform rounds correctly, with `std` or without.

/// `a b + c`, rounded once.
#[inline(always)]
pub(crate) fn fused(a: f64, b: f64, c: f64) -> f64 {
    #[cfg(feature = "std")]
    {
        // An instruction where the function around it may use it, else a call of the platform's: the same bits.
        a.mul_add(b, c)
    }
    #[cfg(not(feature = "std"))]
    {
        libm::fma(a, b, c)
    }
}

/// The square root, rounded correctly.
#[inline(always)]
pub(crate) fn sqrt(x: f64) -> f64 {
    #[cfg(feature = "std")]
    {
        x.sqrt()
    }
    #[cfg(not(feature = "std"))]
    {
        libm::sqrt(x)
    }
}
