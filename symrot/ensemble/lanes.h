/*
 * SYMROT_LANES numbers at once: GNU vectors if the compiler has them, otherwise one number in plain C.
 *
 * Included before an emitted jet and lanes.c. Every operation acts on each lane separately, with the same rounding, so
 * that the bits of a lane do not depend on the others. Define SYMROT_LANES as their number, SYMROT_PLAIN for plain C.
 */
#if defined(__FAST_MATH__)
#error "compensated sums do not survive -ffast-math: compile the lanes without it"
#endif

/* The hyperbolic secant, which is 0 if the cosine overflows. */
static inline double sech(double x) { return 1.0/cosh(x); }
#if defined(__GNUC__) && !defined(SYMROT_PLAIN)
#define SYMROT_APART __attribute__((noinline))  /* not inlined: its loops then have all registers */
#if !defined(SYMROT_LANES)
#if defined(__AVX512F__)
#define SYMROT_LANES 8
#elif defined(__AVX__)
#define SYMROT_LANES 4
#else
#define SYMROT_LANES 2  /* no wider than a register: vectors on the stack are slow */
#endif
#endif
#else
#define SYMROT_APART
#undef SYMROT_LANES
#define SYMROT_LANES 1
#endif

#if SYMROT_LANES > 1
typedef double symrot_v __attribute__((vector_size(8*SYMROT_LANES)));
typedef int64_t symrot_bits __attribute__((vector_size(8*SYMROT_LANES)));  /* a mask has all bits of a lane, or none */
#define V_ALL(s) ((double)(s) - (symrot_v){0.0})
#define V_LANE(v, i) ((v)[i])
#if SYMROT_LANES == 4 && defined(__AVX__) && defined(__GNUC__) && !defined(__clang__)  /* gcc does not find these */
#define V_SELECT(m, a, b) __builtin_ia32_blendvpd256(b, a, (symrot_v)(m))
#define V_ANY(m) (__builtin_ia32_movmskpd256((symrot_v)(m)) != 0)
#else
#define V_SELECT(m, a, b) ((symrot_v)(((symrot_bits)(a) & (m)) | ((symrot_bits)(b) & ~(m))))
#define V_ANY(m) symrot_any(m)
#endif
#define V_LESS(a, b) ((symrot_bits)((a) < (b)))
#define V_EQUAL(a, b) ((symrot_bits)((a) == (b)))
#define V_HAS(bits, one) ((symrot_bits)(((bits) & (one)) != 0))
#define V_TO_BITS(v) ((symrot_bits)(v))
#define V_FROM_BITS(b) ((symrot_v)(b))
#define V_NO_BITS ((symrot_bits){0})
#else
typedef double symrot_v;
typedef int64_t symrot_bits;
#define V_ALL(s) ((double)(s))
#define V_LANE(v, i) ((&(v))[i])
#define V_SELECT(m, a, b) ((m) ? (a) : (b))
#define V_ANY(m) ((m) != 0)
#define V_LESS(a, b) (-(symrot_bits)((a) < (b)))
#define V_EQUAL(a, b) (-(symrot_bits)((a) == (b)))
#define V_HAS(bits, one) (-(symrot_bits)(((bits) & (one)) != 0))
#define V_TO_BITS(v) symrot_to_bits(v)
#define V_FROM_BITS(b) symrot_from_bits(b)
#define V_NO_BITS ((symrot_bits)0)
static inline symrot_bits symrot_to_bits(double v)
{
    symrot_bits b;
    memcpy(&b, &v, sizeof b);
    return b;
}
static inline double symrot_from_bits(symrot_bits b)
{
    double v;
    memcpy(&v, &b, sizeof v);
    return v;
}
#endif

#define V_ADD(a, b) ((a) + (b))
#define V_SUB(a, b) ((a) - (b))
#define V_MUL(a, b) ((a)*(b))
#define V_DIV(a, b) ((a)/(b))
#define V_FMA(a, b, c) ((a)*(b) + (c))
#define V_FNMA(a, b, c) ((c) - (a)*(b))

#define EACH_LANE(l) for (int l = 0; l < SYMROT_LANES; ++l)
#define V_CALL(function, v) symrot_call(function, v)
#define V_CALL2(function, v, u) symrot_call2(function, v, u)

/* Return the values of a function for all lanes, computed one after the other. */
static inline symrot_v symrot_call(double (*function)(double), symrot_v v)
{
    EACH_LANE(l) V_LANE(v, l) = function(V_LANE(v, l));
    return v;
}

static inline symrot_v symrot_call2(double (*function)(double, double), symrot_v v, symrot_v u)
{
    EACH_LANE(l) V_LANE(v, l) = function(V_LANE(v, l), V_LANE(u, l));
    return v;
}

static inline int symrot_any(symrot_bits mask)
{
    int64_t bits = 0;
    EACH_LANE(l) bits |= V_LANE(mask, l);
    return bits != 0;
}

static inline symrot_v symrot_size_of(symrot_v v)
{
    return V_FROM_BITS(V_TO_BITS(v) & INT64_MAX);
}
