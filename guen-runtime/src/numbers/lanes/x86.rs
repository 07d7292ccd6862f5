//! Registers of x86-64 that a default build may not use, and the test at run time that allows them.
//!
//! All `unsafe` code of the crate is in this file. What makes it sound: the types [`Avx2`] and [`Avx512`] are private
//! here, so that outside nobody can name them; the only way to one is [`Register`]'s methods on a type parameter that
//! [`avx2`] or [`avx512`] has bound, and both ask the processor first.
#![allow(unsafe_code, reason = "instructions beyond the target's are chosen at run time")]

use core::arch::x86_64::*;
use core::mem::transmute;

use crate::numbers::lanes::register::{Pair, Register};
use crate::numbers::lanes::{LaneTask, Width, run};

/// Whether the processor has 256-bit registers with integer operations, and fused multiply-add.
#[inline]
pub(super) fn has_avx2() -> bool {
    #[cfg(feature = "std")]
    {
        std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
    }
    #[cfg(not(feature = "std"))]
    {
        cfg!(all(target_feature = "avx2", target_feature = "fma"))
    }
}

/// Whether it has 512-bit registers, and the same instructions for shorter ones.
#[inline]
pub(super) fn has_avx512() -> bool {
    has_avx2() && has_avx512_besides()
}

/// Returns `true` if a processor with 256-bit registers has 512-bit ones, too.
#[inline]
fn has_avx512_besides() -> bool {
    #[cfg(feature = "std")]
    {
        std::arch::is_x86_feature_detected!("avx512f")
            && std::arch::is_x86_feature_detected!("avx512dq")
            && std::arch::is_x86_feature_detected!("avx512vl")
    }
    #[cfg(not(feature = "std"))]
    {
        cfg!(all(target_feature = "avx512f", target_feature = "avx512dq", target_feature = "avx512vl"))
    }
}

/// Runs a task in registers of 256 bits, if the processor has them.
pub(super) fn avx2<T: LaneTask>(width: Width, task: T) -> Result<T::Output, T> {
    if !has_avx2() {
        return Err(task);
    }
    Ok(match width {
        Width::One => task.run::<f64>(),
        Width::Four => run::<Avx2, T>(task),
        Width::Eight => run::<Pair<Avx2>, T>(task),
    })
}

/// Runs a task in registers of 512 bits, four lanes in half of one, if the processor has them.
pub(super) fn avx512<T: LaneTask>(width: Width, task: T) -> Result<T::Output, T> {
    if !has_avx512() {
        return Err(task);
    }
    Ok(match width {
        Width::One => task.run::<f64>(),
        Width::Four => run::<Avx512Half, T>(task),
        Width::Eight => run::<Avx512, T>(task),
    })
}

// A function may be inlined where at least its own instructions are allowed: what is called from here can come in, and
// these two cannot get out into code for every processor, but into one another.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn with_avx2<T>(function: impl FnOnce() -> T) -> T {
    function()
}

#[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl")]
#[inline]
fn with_avx512<T>(function: impl FnOnce() -> T) -> T {
    function()
}

/// Calls a function where fused multiply-add is one instruction, if the processor has it.
#[inline(always)]
pub(super) fn fused<T>(function: impl FnOnce() -> T) -> T {
    if has_avx2() {
        // SAFETY: the processor has been asked.
        unsafe { with_avx2(function) }
    } else {
        function()
    }
}

/// Calls a function with the longest registers that the processor has.
#[inline(always)]
pub(super) fn wide<T>(function: impl FnOnce() -> T) -> T {
    if !has_avx2() {
        function()
    } else if has_avx512_besides() {
        // SAFETY: the processor has been asked, for both.
        unsafe { with_avx512(function) }
    } else {
        // SAFETY: the processor has been asked.
        unsafe { with_avx2(function) }
    }
}

/// Two lanes, on every processor of x86-64.
#[derive(Clone, Copy)]
pub(crate) struct Sse2(__m128d);

/// Four lanes.
#[derive(Clone, Copy)]
struct Avx2(__m256d);

/// Four lanes, with twice the number of registers.
#[derive(Clone, Copy)]
struct Avx512Half(__m256d);

/// Eight lanes.
#[derive(Clone, Copy)]
struct Avx512(__m512d);

/// Operations of one instruction. SAFETY of all: a value of these types exists only where the processor has been
/// asked, or need not be.
macro_rules! instructions {
    ($($method:ident: $instruction:ident;)*) => {
        $(
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(unsafe { $instruction(self.0, other.0) })
            }
        )*
    };
}

macro_rules! lanes {
    ($count:literal of $register:ty) => {
        const COUNT: usize = $count;

        #[inline(always)]
        fn from_fn(mut lane: impl FnMut(usize) -> f64) -> Self {
            let mut all = [0.0; $count];
            for (i, entry) in all.iter_mut().enumerate() {
                *entry = lane(i);
            }
            // SAFETY: a register is the array of its lanes.
            Self(unsafe { transmute::<[f64; $count], $register>(all) })
        }

        #[inline(always)]
        fn lane(self, index: usize) -> f64 {
            // SAFETY: a register is the array of its lanes.
            let all = unsafe { transmute::<$register, [f64; $count]>(self.0) };
            all[index]
        }
    };
}

macro_rules! register256 {
    ($register:ident, $context:ident) => {
        impl Register for $register {
            lanes!(4 of __m256d);

            instructions! {
                add: _mm256_add_pd;
                sub: _mm256_sub_pd;
                mul: _mm256_mul_pd;
                div: _mm256_div_pd;
                and: _mm256_and_pd;
                xor: _mm256_xor_pd;
            }

            #[inline(always)]
            fn splat(x: f64) -> Self {
                // SAFETY: as of every instruction here.
                Self(unsafe { _mm256_set1_pd(x) })
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: as of every instruction here.
                Self(unsafe { _mm256_sqrt_pd(self.0) })
            }

            #[inline(always)]
            fn fused(self, b: Self, c: Self) -> Self {
                // SAFETY: as of every instruction here.
                Self(unsafe { _mm256_fmadd_pd(self.0, b.0, c.0) })
            }

            #[inline(always)]
            fn without(self, other: Self) -> Self {
                // SAFETY: as of every instruction here. This one inverts its first operand.
                Self(unsafe { _mm256_andnot_pd(other.0, self.0) })
            }

            #[inline(always)]
            fn raised<const BY: i32>(self) -> Self {
                // SAFETY: as of every instruction here.
                Self(unsafe { _mm256_castsi256_pd(_mm256_slli_epi64::<BY>(_mm256_castpd_si256(self.0))) })
            }

            #[inline(always)]
            fn by_sign(self, set: Self, clear: Self) -> Self {
                // SAFETY: as of every instruction here. This one looks at signs alone.
                Self(unsafe { _mm256_blendv_pd(clear.0, set.0, self.0) })
            }

            #[inline(always)]
            fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
                // SAFETY: as of every instruction here.
                Self(unsafe {
                    let mask = _mm256_cmp_pd::<_CMP_NLE_UQ>(self.0, limit.0);
                    _mm256_blendv_pd(below.0, above.0, mask)
                })
            }

            #[inline(always)]
            fn some_above(self, limit: f64) -> bool {
                // SAFETY: as of every instruction here.
                unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(self.0, _mm256_set1_pd(limit))) != 0 }
            }

            #[inline(always)]
            fn finite(self) -> u32 {
                // SAFETY: as of every instruction here. `x - x` is NaN unless `x` is finite, and NaN equals nothing.
                unsafe {
                    let rest = _mm256_sub_pd(self.0, self.0);
                    _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_EQ_OQ>(rest, rest)) as u32
                }
            }

            #[inline(always)]
            fn vectorize<T>(function: impl FnOnce() -> T) -> T {
                // SAFETY: as of every instruction here.
                unsafe { $context(function) }
            }
        }
    };
}

register256!(Avx2, with_avx2);
register256!(Avx512Half, with_avx512);

impl Register for Avx512 {
    lanes!(8 of __m512d);

    instructions! {
        add: _mm512_add_pd;
        sub: _mm512_sub_pd;
        mul: _mm512_mul_pd;
        div: _mm512_div_pd;
        and: _mm512_and_pd;
        xor: _mm512_xor_pd;
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe { _mm512_set1_pd(x) })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe { _mm512_fmadd_pd(self.0, b.0, c.0) })
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        // SAFETY: as of every instruction here. This one inverts its first operand.
        Self(unsafe { _mm512_andnot_pd(other.0, self.0) })
    }

    #[inline(always)]
    fn raised<const BY: i32>(self) -> Self {
        // SAFETY: as of every instruction here. The count is constant, so that the compiler takes the immediate form,
        // whose own function counts in another type.
        Self(unsafe {
            let bits = _mm512_castpd_si512(self.0);
            _mm512_castsi512_pd(_mm512_sll_epi64(bits, _mm_cvtsi32_si128(BY)))
        })
    }

    #[inline(always)]
    fn by_sign(self, set: Self, clear: Self) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe {
            let signs = _mm512_movepi64_mask(_mm512_castpd_si512(self.0));
            _mm512_mask_blend_pd(signs, clear.0, set.0)
        })
    }

    #[inline(always)]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe {
            let mask = _mm512_cmp_pd_mask::<_CMP_NLE_UQ>(self.0, limit.0);
            _mm512_mask_blend_pd(mask, below.0, above.0)
        })
    }

    #[inline(always)]
    fn some_above(self, limit: f64) -> bool {
        // SAFETY: as of every instruction here.
        unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, _mm512_set1_pd(limit)) != 0 }
    }

    #[inline(always)]
    fn finite(self) -> u32 {
        // SAFETY: as of every instruction here. `x - x` is NaN unless `x` is finite, and NaN equals nothing.
        unsafe {
            let rest = _mm512_sub_pd(self.0, self.0);
            u32::from(_mm512_cmp_pd_mask::<_CMP_EQ_OQ>(rest, rest))
        }
    }

    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        // SAFETY: as of every instruction here.
        unsafe { with_avx512(function) }
    }
}

impl Register for Sse2 {
    lanes!(2 of __m128d);

    instructions! {
        add: _mm_add_pd;
        sub: _mm_sub_pd;
        mul: _mm_mul_pd;
        div: _mm_div_pd;
        and: _mm_and_pd;
        xor: _mm_xor_pd;
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe { _mm_set1_pd(x) })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe { _mm_sqrt_pd(self.0) })
    }

    // The instruction came later.
    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        Self::from_fn(|i| crate::numbers::elementary::fused(self.lane(i), b.lane(i), c.lane(i)))
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        // SAFETY: as of every instruction here. This one inverts its first operand.
        Self(unsafe { _mm_andnot_pd(other.0, self.0) })
    }

    #[inline(always)]
    fn raised<const BY: i32>(self) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe { _mm_castsi128_pd(_mm_slli_epi64::<BY>(_mm_castpd_si128(self.0))) })
    }

    #[inline(always)]
    fn by_sign(self, set: Self, clear: Self) -> Self {
        // SAFETY: as of every instruction here. Signs are spread over halves, the upper halves over both.
        Self(unsafe {
            let halves = _mm_srai_epi32::<31>(_mm_castpd_si128(self.0));
            let mask = _mm_castsi128_pd(_mm_shuffle_epi32::<0b11_11_01_01>(halves));
            _mm_or_pd(_mm_and_pd(mask, set.0), _mm_andnot_pd(mask, clear.0))
        })
    }

    #[inline(always)]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        // SAFETY: as of every instruction here.
        Self(unsafe {
            let mask = _mm_cmpnle_pd(self.0, limit.0);
            _mm_or_pd(_mm_and_pd(mask, above.0), _mm_andnot_pd(mask, below.0))
        })
    }

    #[inline(always)]
    fn some_above(self, limit: f64) -> bool {
        // SAFETY: as of every instruction here.
        unsafe { _mm_movemask_pd(_mm_cmpgt_pd(self.0, _mm_set1_pd(limit))) != 0 }
    }

    #[inline(always)]
    fn finite(self) -> u32 {
        // SAFETY: as of every instruction here. `x - x` is NaN unless `x` is finite, and NaN equals nothing.
        unsafe {
            let rest = _mm_sub_pd(self.0, self.0);
            _mm_movemask_pd(_mm_cmpeq_pd(rest, rest)) as u32
        }
    }

    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        function()
    }
}
