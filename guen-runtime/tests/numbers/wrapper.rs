//! The operators of a scalar that wraps another number.

macro_rules! operators {
    ($Scalar:ident; $($trait:ident $method:ident $assign:ident $assign_method:ident;)*) => {
        $(impl core::ops::$trait for $Scalar {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(core::ops::$trait::$method(self.0, other.0))
            }
        }
        impl core::ops::$assign for $Scalar {
            fn $assign_method(&mut self, other: Self) {
                core::ops::$assign::$assign_method(&mut self.0, other.0);
            }
        })*
        impl core::ops::Neg for $Scalar {
            type Output = Self;
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }
    };
    ($Scalar:ident) => {
        crate::wrapper::operators! { $Scalar; Add add AddAssign add_assign; Sub sub SubAssign sub_assign; Mul mul MulAssign mul_assign; Div div DivAssign div_assign; }
    };
}
pub(crate) use operators;
