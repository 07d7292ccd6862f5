//! Scenes drawn at random, as the compiler sees them: they compile, and their rates are those of the whole system.
//!
//! The systems are written by `GUEN_BLESS=1 cargo test -p guen-language --test declarations random_declarations::compiled`.

/// A test of some scenes, each with states of the whole system.
macro_rules! same {
    ($($scene:expr, $states:expr;)*) => {
        #[test]
        fn rates_are_those_of_the_whole_system() {
            $({
                let scene = $scene;
                let whole = scene.system().prepare().expect("a system");
                let scene = scene.prepare().expect("a scene");
                crate::compare::assert_same_rates(&whole, &scene, &$states, crate::random_scenes::ROUNDING);
            })*
        }
    };
}

#[rustfmt::skip]
#[allow(unused_variables, reason = "a drawn constant may be in nothing")]
mod systems;

/// Largest difference of rates, in units of the largest of them and one: the mass matrices have conditions of a few hundred.
const ROUNDING: f64 = 1e-12;
