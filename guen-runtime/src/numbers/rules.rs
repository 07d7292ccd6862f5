//! Rules that numbers with something beside their value share: the rules of derivatives, and operators that assign.

/// Elementary functions of one argument by `chain(value, slope)`, for a type with the argument in `value`, each with an
/// attribute that says how it is inlined; with a module behind it by `chain(value, slope, own)`, where it has a constant for what each
/// function adds.
///
/// Radicands are products, which keep their digits near the ends; `tanh' = 1 / cosh^2` and not `1 - tanh^2`, which
/// cancels for large arguments.
macro_rules! by_slopes {
    ($inline:meta $(, $own:ident)?) => {
        // sin' = cos, cos' = -sin
        #[$inline]
        fn sin_cos(self) -> (Self, Self) {
            let (sin, cos) = self.value.sin_cos();
            (self.chain(sin, cos $(, $own::SINE)?), self.chain(cos, -sin $(, $own::SINE)?))
        }

        // asin' = 1 / sqrt(1 - u^2)
        #[$inline]
        fn asin(self) -> Self {
            let u = self.value;
            self.chain(u.asin(), ((R::one() - u) * (R::one() + u)).sqrt().recip() $(, $own::INVERSE)?)
        }

        // acos' = -1 / sqrt(1 - u^2)
        #[$inline]
        fn acos(self) -> Self {
            let u = self.value;
            self.chain(u.acos(), -((R::one() - u) * (R::one() + u)).sqrt().recip() $(, $own::INVERSE)?)
        }

        // atan' = 1 / (1 + u^2)
        #[$inline]
        fn atan(self) -> Self {
            let u = self.value;
            self.chain(u.atan(), (R::one() + u * u).recip() $(, $own::ARC_TANGENT)?)
        }

        // sinh' = cosh
        #[$inline]
        fn sinh(self) -> Self {
            self.chain(self.value.sinh(), self.value.cosh() $(, $own::HYPERBOLIC)?)
        }

        // cosh' = sinh
        #[$inline]
        fn cosh(self) -> Self {
            self.chain(self.value.cosh(), self.value.sinh() $(, $own::HYPERBOLIC)?)
        }

        // tanh' = 1 / cosh^2
        #[$inline]
        fn tanh(self) -> Self {
            let sech = self.value.cosh().recip();
            self.chain(self.value.tanh(), sech * sech $(, $own::HYPERBOLIC)?)
        }

        // exp' = exp
        #[$inline]
        fn exp(self) -> Self {
            let exp = self.value.exp();
            self.chain(exp, exp $(, $own::EXPONENTIAL)?)
        }

        // ln' = 1 / u
        #[$inline]
        fn ln(self) -> Self {
            self.chain(self.value.ln(), self.value.recip() $(, $own::EXPONENTIAL)?)
        }

        // sqrt' = 1 / (2 sqrt)
        #[$inline]
        fn sqrt(self) -> Self {
            let root = self.value.sqrt();
            self.chain(root, (root + root).recip() $(, $own::SQUARE_ROOT)?)
        }

        // root_q' = 1 / (q root_q^(q - 1))
        #[$inline]
        fn root(self, q: u32) -> Self {
            let root = self.value.root(q);
            let power = root.powi(i32::try_from(i64::from(q) - 1).unwrap_or(i32::MAX));
            self.chain(root, (R::from_ratio(i64::from(q), 1) * power).recip() $(, $own::ROOT)?)
        }
    };
}

/// `+=`, `-=`, `*=` and `/=` by the operators: `assign_operators!(Number<R>, R: Real)`.
macro_rules! assign_operators {
    (@one $trait:ident $method:ident $operator:tt, $type:ty, $($parameters:tt)*) => {
        impl<$($parameters)*> core::ops::$trait for $type {
            // Always: an operator of lanes that is a call loses their instructions.
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    };
    ($type:ty, $($parameters:tt)*) => {
        assign_operators!(@one AddAssign add_assign +, $type, $($parameters)*);
        assign_operators!(@one SubAssign sub_assign -, $type, $($parameters)*);
        assign_operators!(@one MulAssign mul_assign *, $type, $($parameters)*);
        assign_operators!(@one DivAssign div_assign /, $type, $($parameters)*);
    };
}

pub(crate) use {assign_operators, by_slopes};
