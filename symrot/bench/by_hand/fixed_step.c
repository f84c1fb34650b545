/*
 * Classical RK4 and DOP853 with a fixed step, by hand around a right-hand side: the yardsticks at low accuracy of
 * `python -m symrot.bench.taylor`. Follows the text of symrot_rates and dop853_tableau.h; N is the number of states.
 * No step control, no error estimate, no dense output, nothing but the stages: the least that a method can cost.
 */
#define FOR for (int i = 0; i < N; ++i)

void symrot_rk4(double t, double stop, long steps, double *state, const double *p)
{
    const double h = (stop - t)/steps;
    double y[N], k1[N], k2[N], k3[N], k4[N], z[N];
    FOR y[i] = state[i];
    for (long n = 0; n < steps; ++n) {
        const double now = t + n*h;
        symrot_rates(now, y, p, k1);
        FOR z[i] = y[i] + 0.5*h*k1[i];
        symrot_rates(now + 0.5*h, z, p, k2);
        FOR z[i] = y[i] + 0.5*h*k2[i];
        symrot_rates(now + 0.5*h, z, p, k3);
        FOR z[i] = y[i] + h*k3[i];
        symrot_rates(now + h, z, p, k4);
        FOR y[i] += h/6.0*(k1[i] + 2.0*k2[i] + 2.0*k3[i] + k4[i]);
    }
    FOR state[i] = y[i];
}

#define K(s) k[s][i]
#define STAGE(s, before) \
        FOR z[i] = y[i] + h*(DOP853_OLD_##s(K) + DOP853_NEW_##s*k[before][i]); \
        symrot_rates(now + DOP853_NODE_##s*h, z, p, k[s]);

void symrot_dop853(double t, double stop, long steps, double *state, const double *p)
{
    const double h = (stop - t)/steps;
    double y[N], z[N], k[13][N];
    FOR y[i] = state[i];
    for (long n = 0; n < steps; ++n) {
        const double now = t + n*h;
        symrot_rates(now, y, p, k[1]);
        STAGE(2, 1)
        STAGE(3, 2)
        STAGE(4, 3)
        STAGE(5, 4)
        STAGE(6, 5)
        STAGE(7, 6)
        STAGE(8, 7)
        STAGE(9, 8)
        STAGE(10, 9)
        STAGE(11, 10)
        FOR z[i] = y[i] + h*(DOP853_OLD_12(K) + DOP853_NEW_12*k[11][i]);
        symrot_rates(now + h, z, p, k[12]);
        FOR y[i] += h*DOP853_WEIGHTS(K);
    }
    FOR state[i] = y[i];
}
