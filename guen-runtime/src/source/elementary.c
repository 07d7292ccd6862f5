/* Functions that the programs of several systems share: once in a translation unit. */
#ifndef GUEN_ELEMENTARY
#define GUEN_ELEMENTARY

/* A compiler at run time has these functions without a header. */
#ifndef __CUDACC_RTC__
#include <math.h>
#endif

#ifdef __FAST_MATH__
#error "guen: -ffast-math changes the results"
#endif
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0 && __FLT_EVAL_METHOD__ != 16
#error "guen: doubles are to be computed as doubles; on x86 say -mfpmath=sse -msse2"
#endif
#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

/* What stands before every function; define it first where another word is needed, such as `__device__ static`. */
#ifndef GUEN_FUNCTION
#define GUEN_FUNCTION static inline
#endif

typedef union { double number; unsigned long long bits; } guen_double;

GUEN_FUNCTION unsigned long long guen_bits(double x)
{
    guen_double both;
    both.number = x;
    return both.bits;
}

GUEN_FUNCTION double guen_from_bits(unsigned long long bits)
{
    guen_double both;
    both.bits = bits;
    return both.number;
}

GUEN_FUNCTION int guen_is_finite(double x)
{
    return (guen_bits(x) >> 52 & 0x7ff) != 0x7ff;
}

/* Sine and cosine of x = n pi/2 + r + tail, by the two lowest bits of n. */
typedef struct { unsigned long long n; double r, tail; } guen_reduced;

GUEN_FUNCTION double guen_sine_kernel(double r, double tail)
{
    double z = r * r, cube = z * r;
    double series = (z * (z * 2.75573137070700676789e-06 + -1.98412698298579493134e-04) + 8.33333333332248946124e-03)
        + z * (z * z) * (z * 1.58969099521155010221e-10 + -2.50507602534068634195e-08);
    return r - ((z * (tail * 0.5 - cube * series) - tail) - cube * -1.66666666666666324348e-01);
}

GUEN_FUNCTION double guen_cosine_kernel(double r, double tail)
{
    double z = r * r, w = z * z, half = z * 0.5;
    double series = z * (z * (z * 2.48015872894767294178e-05 + -1.38888888888741095749e-03) + 4.16666666666666019037e-02)
        + w * w * (z * (z * -1.13596475577881948265e-11 + 2.08757232129817482790e-09) + -2.75573143513906633035e-07);
    double leading = 1.0 - half;
    return leading + (((1.0 - leading) - half) + (z * series - r * tail));
}

/* The product of two words, in two. */
GUEN_FUNCTION unsigned long long guen_product(unsigned long long a, unsigned long long b, unsigned long long *low)
{
    unsigned long long mask = 0xffffffffULL;
    unsigned long long a1 = a >> 32, a0 = a & mask, b1 = b >> 32, b0 = b & mask;
    unsigned long long corner = a0 * b0;
    unsigned long long first = a1 * b0 + (corner >> 32);
    unsigned long long second = a0 * b1 + (first & mask);
    *low = second << 32 | (corner & mask);
    return a1 * b1 + (first >> 32) + (second >> 32);
}

/* The remainder of a number above 2^18 by pi/2, after Payne and Hanek: |x| = n pi/2 + r + tail. */
GUEN_FUNCTION guen_reduced guen_remainder(double x)
{
    /* The bits of 2/pi behind the point, after one word of zeros. */
    const unsigned long long two_over_pi[20] = {
        0x0ULL, 0xa2f9836e4e441529ULL, 0xfc2757d1f534ddc0ULL, 0xdb6295993c439041ULL, 0xfe5163abdebbc561ULL,
        0xb7246e3a424dd2e0ULL, 0x06492eea09d1921cULL, 0xfe1deb1cb129a73eULL, 0xe88235f52ebb4484ULL, 0xe99c7026b45f7e41ULL,
        0x3991d639835339f4ULL, 0x9c845f8bbdf9283bULL, 0x1ff897ffde05980fULL, 0xef2f118b5a0a6d1fULL, 0x6d367ecf27cb09b7ULL,
        0x4f463f669e5fea2dULL, 0x7527bac7ebe5f17bULL, 0x3d0739f78a5292eaULL, 0x6bfb5fb11f8d5d08ULL, 0x56033046fc7b6babULL
    };
    /* pi/4 in two words. */
    const unsigned long long pi1 = 0xc90fdaa22168c234ULL, pi0 = 0xc4c6628b80dc1cd1ULL;
    guen_reduced reduced;
    unsigned long long bits = guen_bits(fabs(x)), exponent = bits >> 52;
    unsigned long long mantissa = (bits & 0xfffffffffffffULL) | 1ULL << 52;
    unsigned long long first, shift, window[3], low0, middle0, high, carry, fraction1, fraction0, r1, r0, part, unused;
    int i, word, zeros, above;
    if (exponent == 0x7ff) {
        reduced.n = 0;
        reduced.r = reduced.tail = x - x;
        return reduced;
    }
    first = exponent + 64 > 1077 ? exponent + 64 - 1077 : 0;
    word = (int)(first / 64);
    shift = first % 64;
    for (i = 0; i < 3; ++i) {
        unsigned long long at = word + i < 20 ? two_over_pi[word + i] : 0;
        unsigned long long next = word + i + 1 < 20 ? two_over_pi[word + i + 1] : 0;
        window[i] = shift ? at << shift | next >> (64 - shift) : at;
    }
    /* The product modulo 2^192. */
    carry = guen_product(mantissa, window[2], &low0);
    part = guen_product(mantissa, window[1], &middle0);
    middle0 += carry;
    part += middle0 < carry;
    (void)guen_product(mantissa, window[0], &high);
    high += part;
    reduced.n = high >> 62;
    fraction1 = high << 2 | middle0 >> 62;
    fraction0 = middle0 << 2 | low0 >> 62;
    /* To the nearest multiple. */
    above = (int)(fraction1 >> 63);
    if (above) {
        fraction0 = ~fraction0 + 1;
        fraction1 = ~fraction1 + (fraction0 == 0);
    }
    zeros = 0;
    while (zeros < 128 && !(fraction1 >> 63)) {
        fraction1 = fraction1 << 1 | fraction0 >> 63;
        fraction0 <<= 1;
        ++zeros;
    }
    /* The upper half of the product with pi/4, less at most three units. */
    r1 = guen_product(fraction1, pi1, &r0);
    carry = guen_product(fraction1, pi0, &unused);
    r0 += carry;
    r1 += r0 < carry;
    carry = guen_product(fraction0, pi1, &unused);
    r0 += carry;
    r1 += r0 < carry;
    reduced.r = (double)(r1 >> 11) * guen_from_bits((unsigned long long)(1023 - 52 - zeros) << 52);
    reduced.tail = (double)(r1 << 53 | r0 >> 11) * guen_from_bits((unsigned long long)(1023 - 116 - zeros) << 52);
    if (above) {
        reduced.n += 1;
        reduced.r = -reduced.r;
        reduced.tail = -reduced.tail;
    }
    return reduced;
}

/* The reduction of Cody and Waite up to 2^18: pi/2 in three parts, whose products with n are exact. */
GUEN_FUNCTION guen_reduced guen_reduce(double x)
{
    guen_reduced reduced;
    double quadrant, n, far, step, near, lost;
    if (fabs(x) > 262144.0) {
        reduced = guen_remainder(x);
        return reduced;
    }
    quadrant = x * 0.6366197723675814 + 6755399441055744.0;
    n = quadrant - 6755399441055744.0;
    far = x - n * guen_from_bits(0x3ff921fb54400000ULL);
    step = n * guen_from_bits(0x3dd0b4611a600000ULL);
    near = far - step;
    lost = (far - near) - step;
    step = n * guen_from_bits(0x3ba3198a2e037073ULL) - lost;
    reduced.n = guen_bits(quadrant);
    reduced.r = near - step;
    reduced.tail = (near - reduced.r) - step;
    return reduced;
}

GUEN_FUNCTION void guen_sincos(double x, double *sine, double *cosine)
{
    guen_reduced reduced = guen_reduce(x);
    unsigned long long odd = reduced.n << 63, upper = reduced.n << 62 & 1ULL << 63;
    double s = guen_sine_kernel(reduced.r, reduced.tail), c = guen_cosine_kernel(reduced.r, reduced.tail);
    double first = guen_from_bits(guen_bits(odd ? c : s) ^ upper);
    *cosine = guen_from_bits(guen_bits(odd ? s : c) ^ upper ^ odd);
    *sine = x < -262144.0 ? -first : first;
}

GUEN_FUNCTION double guen_sin(double x)
{
    double sine, cosine;
    guen_sincos(x, &sine, &cosine);
    return sine;
}

GUEN_FUNCTION double guen_cos(double x)
{
    double sine, cosine;
    guen_sincos(x, &sine, &cosine);
    return cosine;
}

/* Smaller and larger of two, NaN where one of them is; a choice between two; the sign. */
GUEN_FUNCTION double guen_minimum(double a, double b)
{
    return a <= b ? a : b <= a ? b : a + b;
}

GUEN_FUNCTION double guen_maximum(double a, double b)
{
    return a <= b ? b : b <= a ? a : a + b;
}

GUEN_FUNCTION double guen_select(double c, double a, double b)
{
    return -c <= 0.0 ? a : c <= 0.0 ? b : c;
}

GUEN_FUNCTION double guen_sign(double x)
{
    return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x == 0.0 ? 0.0 : x;
}

/* The real root of order q > 3: a power and one step of Newton's. */
GUEN_FUNCTION double guen_root(double x, unsigned q)
{
    double size = fabs(x), guess, power;
    if (q % 2 == 0 && x < 0.0)
        return (x - x) / 0.0;
    guess = pow(size, 1.0 / q);
    power = pow(guess, q - 1.0);
    if (power >= 2.2250738585072014e-308 && guess >= 2.2250738585072014e-308 && guen_is_finite(power)
        && guen_is_finite(size))
        guess = guess - (guess - size / power) / q;
    return x < 0.0 ? -guess : x == 0.0 ? x : guess;
}

/* The number of steps of a size over a span; a rest of a few roundings is no further step. */
GUEN_FUNCTION double guen_steps(double span, double size)
{
    double steps = ceil(fabs(span / size) * (1.0 - 4.0 * 2.2204460492503131e-16));
    return steps > 1.0 ? steps : 1.0;
}

/* The settings of a method that chooses its steps, and the work of a run, which it writes. */
typedef struct {
    /* The tolerances: an error e in an entry x counts as e / (atol + rtol |x|). */
    double rtol, atol;
    /* The first step to try; estimated if 0. */
    double first_step;
    /* The largest number of trial steps of a run. */
    unsigned long long max_steps;
    unsigned long long evaluations, accepted, rejected;
} guen_adaptive;

/* The logarithm to the base two of a positive finite number, and powers of two, to almost four digits: enough for steps. */
GUEN_FUNCTION double guen_rough_log2(double x)
{
    unsigned long long bits = guen_bits(x), one = 0x3ff0000000000000ULL;
    double m = guen_from_bits((bits & 0xfffffffffffffULL) | one) - 1.0;
    double linear = (double)((long long)bits - (long long)one) * 2.2204460492503131e-16;
    return linear + (m * (1.0 - m)) * ((0.438726 + -0.239058 * m) + 0.0821306 * (m * m));
}

GUEN_FUNCTION double guen_rough_exp2(double x)
{
    double shifted = x + 6755399441055744.0, f = x - (shifted - 6755399441055744.0);
    double mantissa = 1.0 + f * ((0.693283 + 0.242211 * f) + 0.0550089 * (f * f));
    return guen_from_bits(guen_bits(mantissa) + (guen_bits(shifted) << 52));
}

GUEN_FUNCTION double guen_rough_root(double x, double power)
{
    return x > 0.0 && guen_is_finite(x) ? guen_rough_exp2(guen_rough_log2(x) * (1.0 / power)) : x;
}

/* The factor on a step of order eight that is predicted to meet the tolerance, for one with an error of 2^(-margin/2). */
GUEN_FUNCTION double guen_factor(double margin)
{
    return 0.8 * guen_rough_exp2(margin * (0.5 / 8.0));
}

/* The shortest step of a run that began at `origin`. */
GUEN_FUNCTION double guen_shortest(double time, double origin)
{
    double elapsed = 10.0 * fabs(time - origin), clock = fabs(time);
    return 2.2204460492503131e-16 * (elapsed > clock ? elapsed : clock);
}

/* Whether a comes before b in a run that goes backwards or not. */
GUEN_FUNCTION int guen_earlier(double a, double b, int backwards)
{
    return a != b && (b - a < 0.0) == backwards;
}

/* Whether times run in order between two; they may repeat. */
GUEN_FUNCTION int guen_in_order(double start, double end, int count, const double *times)
{
    int i;
    for (i = 0; i <= count && count; ++i) {
        double next = i < count ? times[i] : end, ahead = next - (i ? times[i - 1] : start);
        if (!(ahead == 0.0 || (fabs(ahead) > 0.0 && (ahead > 0.0) == (end - start >= 0.0))))
            return 0;
    }
    return 1;
}

#endif
