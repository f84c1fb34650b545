/*
 * Four numbers at once: GNU vectors if the compiler has them, otherwise plain C with the same meaning.
 *
 * Vectors are no wider than the vectors of the processor: wider vectors would be on the stack, written in halves and
 * read as a whole, which is slow.
 *
 * Included before an emitted jet and taylor.c. Define SYMROT_PAIRS to use two vectors of two, SYMROT_PLAIN to use plain
 * C.
 */
#if defined(__FAST_MATH__)
#error "compensated sums do not survive -ffast-math: compile the Taylor stepper without it"
#endif

/* The hyperbolic secant, which is 0 if the cosine overflows. */
static inline double sech(double x) { return 1.0/cosh(x); }

#if defined(__GNUC__)
#define SYMROT_APART __attribute__((noinline))  /* not inlined: its loops then have all registers */
#define SYMROT_ALIGNED __attribute__((aligned(32)))
#else
#define SYMROT_APART
#define SYMROT_ALIGNED
#endif

#if defined(__GNUC__) && !defined(SYMROT_PLAIN)
#if defined(__AVX__) && defined(__has_builtin) && !defined(SYMROT_PAIRS)
#if __has_builtin(__builtin_shufflevector)
#define SYMROT_WHOLE
#endif
#endif
#if !defined(SYMROT_WHOLE) && !defined(SYMROT_PAIRS)
#define SYMROT_PAIRS
#endif
#endif

#if defined(SYMROT_WHOLE)
typedef double symrot_v4 __attribute__((vector_size(32)));
typedef long long symrot_signs __attribute__((vector_size(32)));
#define V_SET(a, b, c, d) ((symrot_v4){a, b, c, d})
#define V_LANE(v, i) ((v)[i])
#define V_ADD(a, b) ((a) + (b))
#define V_SUB(a, b) ((a) - (b))
#define V_MUL(a, b) ((a)*(b))
#define V_DIV(a, b) ((a)/(b))
#define V_FMA(a, b, c) ((a)*(b) + (c))
#define V_PICK(v, u, i, j, k, l) __builtin_shufflevector(v, u, i, j, k, l)  /* lanes 0-3 of v, 4-7 of u */
#define V_MASK(s) ((s) < 0 ? (long long)(-9223372036854775807LL - 1) : 0LL)
#define V_FLIP(v, i, j, k, l) \
    ((symrot_v4)((symrot_signs)(v) ^ (symrot_signs){V_MASK(i), V_MASK(j), V_MASK(k), V_MASK(l)}))
#define V_KEEP(v, i, j, k, l) ((symrot_v4)((symrot_signs)(v) & (symrot_signs){-(i), -(j), -(k), -(l)}))
#define V_ALL(s) symrot_all(s)
static inline symrot_v4 symrot_all(double s) { return V_SET(s, s, s, s); }
#elif defined(SYMROT_PAIRS)
typedef double symrot_v2 __attribute__((vector_size(16)));
typedef long long symrot_signs __attribute__((vector_size(16)));
typedef struct { symrot_v2 low, high; } symrot_v4;
#define V_LANE(v, i) ((i) < 2 ? (v).low[(i) & 1] : (v).high[(i) & 1])
#define V_SET(a, b, c, d) symrot_join((symrot_v2){a, b}, (symrot_v2){c, d})
#define V_ADD(a, b) symrot_add(a, b)
#define V_SUB(a, b) symrot_subtract(a, b)
#define V_MUL(a, b) symrot_multiply(a, b)
#define V_DIV(a, b) symrot_divide(a, b)
#define V_FMA(a, b, c) symrot_fma(a, b, c)
#define V_LANE_OF(v, u, i) ((i) < 4 ? V_LANE(v, (i) & 3) : V_LANE(u, (i) & 3))
#define V_PICK(v, u, i, j, k, l) \
    V_SET(V_LANE_OF(v, u, i), V_LANE_OF(v, u, j), V_LANE_OF(v, u, k), V_LANE_OF(v, u, l))
#define V_MASK(s) ((s) < 0 ? (long long)(-9223372036854775807LL - 1) : 0LL)
#define V_FLIP(v, i, j, k, l) \
    symrot_flip(v, (symrot_signs){V_MASK(i), V_MASK(j)}, (symrot_signs){V_MASK(k), V_MASK(l)})
#define V_KEEP(v, i, j, k, l) symrot_keep_bits(v, (symrot_signs){-(i), -(j)}, (symrot_signs){-(k), -(l)})
#define V_ALL(s) symrot_all(s)
static inline symrot_v4 symrot_join(symrot_v2 low, symrot_v2 high)
{
    symrot_v4 v;
    v.low = low;
    v.high = high;
    return v;
}
static inline symrot_v4 symrot_all(double s) { return V_SET(s, s, s, s); }
#define SYMROT_HALVES(name, operator) \
    static inline symrot_v4 name(symrot_v4 a, symrot_v4 b) \
    { \
        return symrot_join(a.low operator b.low, a.high operator b.high); \
    }
SYMROT_HALVES(symrot_add, +)
SYMROT_HALVES(symrot_subtract, -)
SYMROT_HALVES(symrot_multiply, *)
SYMROT_HALVES(symrot_divide, /)
static inline symrot_v4 symrot_fma(symrot_v4 a, symrot_v4 b, symrot_v4 c)
{
    return symrot_join(a.low*b.low + c.low, a.high*b.high + c.high);
}
static inline symrot_v4 symrot_flip(symrot_v4 v, symrot_signs low, symrot_signs high)
{
    return symrot_join((symrot_v2)((symrot_signs)v.low ^ low), (symrot_v2)((symrot_signs)v.high ^ high));
}
static inline symrot_v4 symrot_keep_bits(symrot_v4 v, symrot_signs low, symrot_signs high)
{
    return symrot_join((symrot_v2)((symrot_signs)v.low & low), (symrot_v2)((symrot_signs)v.high & high));
}
#else
typedef struct { double lane[4]; } symrot_v4;
#define V_LANE(v, i) ((v).lane[i])
#define V_SET(a, b, c, d) symrot_set(a, b, c, d)
#define V_ADD(a, b) symrot_add(a, b)
#define V_SUB(a, b) symrot_subtract(a, b)
#define V_MUL(a, b) symrot_multiply(a, b)
#define V_DIV(a, b) symrot_divide(a, b)
#define V_FMA(a, b, c) symrot_add(symrot_multiply(a, b), c)
#define V_PICK(v, u, i, j, k, l) symrot_pick(v, u, i, j, k, l)
#define V_KEEP(v, i, j, k, l) symrot_multiply(v, symrot_set(i, j, k, l))
#define V_FLIP(v, i, j, k, l) symrot_multiply(v, symrot_set(i, j, k, l))
#define V_ALL(s) symrot_set(s, s, s, s)
static inline symrot_v4 symrot_set(double a, double b, double c, double d)
{
    symrot_v4 v;
    v.lane[0] = a;
    v.lane[1] = b;
    v.lane[2] = c;
    v.lane[3] = d;
    return v;
}
#define SYMROT_LANES(name, operator) \
    static inline symrot_v4 name(symrot_v4 a, symrot_v4 b) \
    { \
        for (int i = 0; i < 4; ++i) a.lane[i] = a.lane[i] operator b.lane[i]; \
        return a; \
    }
SYMROT_LANES(symrot_add, +)
SYMROT_LANES(symrot_subtract, -)
SYMROT_LANES(symrot_multiply, *)
SYMROT_LANES(symrot_divide, /)
static inline symrot_v4 symrot_pick(symrot_v4 v, symrot_v4 u, int i, int j, int k, int l)
{
    return symrot_set(i < 4 ? v.lane[i & 3] : u.lane[i & 3], j < 4 ? v.lane[j & 3] : u.lane[j & 3],
        k < 4 ? v.lane[k & 3] : u.lane[k & 3], l < 4 ? v.lane[l & 3] : u.lane[l & 3]);
}
#endif
typedef symrot_v4 symrot_v;  /* its name in series.h */

/* a b + c with one rounding, unlike V_FMA in some builds: the difference a t - b of large numbers is exact */
static inline symrot_v4 symrot_fused(symrot_v4 a, symrot_v4 b, symrot_v4 c)
{
#define SYMROT_FUSED(i) fma(V_LANE(a, i), V_LANE(b, i), V_LANE(c, i))
    return V_SET(SYMROT_FUSED(0), SYMROT_FUSED(1), SYMROT_FUSED(2), SYMROT_FUSED(3));
#undef SYMROT_FUSED
}
