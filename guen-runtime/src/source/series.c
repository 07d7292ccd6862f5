/* Functions that series of several systems share: once in a translation unit. */
#ifndef GUEN_SERIES
#define GUEN_SERIES

#define GUEN_HIGHEST_ORDER 32
#define GUEN_INFINITY guen_from_bits(0x7ff0000000000000ULL)

/* Takes the coefficients of order m of all factors into the sums of products of higher orders, up to one below the highest order of the series:
   sums[p][m + j] += a_m b_j + b_m a_j for the pair (a, b). */
GUEN_FUNCTION void guen_spread(
    double factors[][16], double sums[][40], const unsigned short *pairs, int count, int list, const double *now, int m, int order)
{
    int last = order - 1, below = m - 1 < last - m ? m - 1 : last - m, blocks = below == 0 ? 0 : below <= 8 ? 1 : 2, i, p;
    if (m >= last)
        return;
    for (p = 0; p < count; ++p) {
        const int a = pairs[2 * p], b = pairs[2 * p + 1];
        for (i = 0; i < 8 * blocks; ++i)
            sums[p][m + 1 + i] += factors[a][i] * now[b] + factors[b][i] * now[a];
        if (2 * m <= last)
            sums[p][2 * m] += now[a] * now[b];
    }
    if (m <= 16)
        for (i = 0; i < list; ++i)
            factors[i][m - 1] = now[i];
}

/* The binary logarithm of a number that is not negative, and powers of two, off by less than a tenth: as if mantissas were linear. */
GUEN_FUNCTION double guen_linear_log2(double x)
{
    return x == 0.0 ? -GUEN_INFINITY : (double)((long long)guen_bits(x) - 0x3ff0000000000000LL) / 4503599627370496.0;
}

GUEN_FUNCTION double guen_linear_exp2(double x)
{
    double within = x < -1022.0 ? -1022.0 : x > 1023.0 ? 1023.0 : x;
    return guen_from_bits((unsigned long long)(within * 4503599627370496.0 + 4607182418800017408.0));
}

/* The power of two next to a positive number. */
GUEN_FUNCTION double guen_power_of_two(double x)
{
    double exponent = round(guen_linear_log2(x));
    exponent = exponent < -1000.0 ? -1000.0 : exponent > 1000.0 ? 1000.0 : exponent;
    return guen_from_bits((unsigned long long)(1023 + (int)exponent) << 52);
}

#endif
