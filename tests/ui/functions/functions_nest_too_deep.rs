//! Functions call each other in a chain of at most 16.
//!
//! repair: `f16(x)` => `f15(x)`

guen::mechanical_system! {
    pub system Surface {
        constants { m > 0, h, g = 9.81 }
        coordinates { x, y }
        fn f0(a) = a*h;
        fn f1(a) = f0(a);
        fn f2(a) = f1(a);
        fn f3(a) = f2(a);
        fn f4(a) = f3(a);
        fn f5(a) = f4(a);
        fn f6(a) = f5(a);
        fn f7(a) = f6(a);
        fn f8(a) = f7(a);
        fn f9(a) = f8(a);
        fn f10(a) = f9(a);
        fn f11(a) = f10(a);
        fn f12(a) = f11(a);
        fn f13(a) = f12(a);
        fn f14(a) = f13(a);
        fn f15(a) = f14(a);
        fn f16(a) = f15(a);
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*f16(x);
    }
}

fn main() {}
