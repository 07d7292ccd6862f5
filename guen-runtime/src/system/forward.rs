//! Methods of a wrapper that the system inside of it answers.

/// The methods of these traits, passed on to another system: `forward!(self -> self.0; System<R, N>, restore, guarded)` inside of an impl.
///
/// A second expression, `|t, state| ..`, is the system for what depends on the inputs, the rates and the invariants.
macro_rules! forward {
    ($self:ident -> $inner:expr; $($what:tt)+) => {
        $crate::system::forward::forward!(@ $self, $inner, |_t, _state| $inner; $($what)+);
    };
    ($self:ident -> $inner:expr, |$t:ident, $state:ident| $here:expr; $($what:tt)+) => {
        $crate::system::forward::forward!(@ $self, $inner, |$t, $state| $here; $($what)+);
    };
    (@ $self:ident, $inner:expr, |$t:ident, $state:ident| $here:expr; System<$R:ty, $N:ident>, restore $(, $guarded:ident)?) => {
        #[inline]
        fn restore(
            &$self,
            t: $R,
            state: &mut [$R; $N],
        ) -> Result<(), $crate::system::constraints::positions_error::PositionsError> {
            $inner.restore(t, state)
        }

        $crate::system::forward::forward!(@ $self, $inner, |$t, $state| $here; System<$R, $N> $(, $guarded)?);
    };
    (@ $self:ident, $inner:expr, |$t:ident, $state:ident| $here:expr; System<$R:ty, $N:ident>, guarded) => {
        #[inline]
        fn guarded(&$self) -> impl $crate::system::guarded::Guarded<$R, $N> {
            $inner.guarded()
        }

        $crate::system::forward::forward!(@ $self, $inner, |$t, $state| $here; System<$R, $N>);
    };
    (@ $self:ident, $inner:expr, |$t:ident, $state:ident| $here:expr; System<$R:ty, $N:ident>) => {
        #[inline]
        fn rhs(&$self, $t: $R, $state: &[$R; $N]) -> [$R; $N] {
            $here.rhs($t, $state)
        }

        #[inline]
        fn switches(&$self, $t: $R, $state: &[$R; $N], values: &mut [$R]) -> usize {
            $here.switches($t, $state, values)
        }
    };
    (@ $self:ident, $inner:expr, |$t:ident, $state:ident| $here:expr; Guarded<$R:ty, $N:ident>) => {
        #[inline]
        fn conserved(&$self, $t: $R, $state: &[$R; $N]) -> $crate::system::invariants::Invariants<$R> {
            $here.conserved($t, $state)
        }

        #[inline]
        fn singularities(
            &$self,
            t: $crate::numbers::running_error::RunningError<$R>,
            state: &[$crate::numbers::running_error::RunningError<$R>; $N],
            values: &mut [$crate::numbers::running_error::RunningError<$R>],
        ) -> usize {
            $inner.singularities(t, state, values)
        }

        #[inline]
        fn condition(&$self, t: $R, state: &[$R; $N]) -> $R {
            $inner.condition(t, state)
        }

        #[inline]
        fn check_costs(&$self) -> $crate::system::check_costs::CheckCosts {
            $inner.check_costs()
        }
    };
    (@ $self:ident, $inner:expr, |$t:ident, $state:ident| $here:expr; Differentiable<$R:ty, $N:ident>) => {
        #[inline]
        fn jacobian(&$self, $t: $R, $state: &[$R; $N]) -> [[$R; $N]; $N] {
            $here.jacobian($t, $state)
        }

        #[inline]
        fn along(&$self, $t: $R, $state: &[$R; $N], dt: $R, dx: &[$R; $N]) -> [$R; $N] {
            $here.along($t, $state, dt, dx)
        }
    };
    (@ $self:ident, $inner:expr, |$t:ident, $state:ident| $here:expr; TaylorSeries<$R:ty, $N:ident>) => {
        const PRODUCTS: usize = S::PRODUCTS;

        #[inline]
        fn series(
            &$self,
            $t: $R,
            $state: &[$R; $N],
            scale: $R,
            order: usize,
            coefficients: &mut Coefficients<$R, $N>,
        ) {
            $here.series($t, $state, scale, order, coefficients);
        }
    };
    (@ $self:ident, $inner:expr, |$t:ident, $state:ident| $here:expr; Monitored<$R:ty, $N:ident>) => {
        #[inline]
        fn energy(&$self, $t: $R, $state: &[$R; $N]) -> $R {
            $here.energy($t, $state)
        }

        #[inline]
        fn residual(&$self, t: $R, state: &[$R; $N]) -> $R {
            $inner.residual(t, state)
        }
    };
}

pub(crate) use forward;
