/*
 * Gragg's modified midpoint rule with 2, 4, .. 16 substeps, extrapolated to none: order 16 with a fixed step, by hand
 * around a right-hand side. It shares no coefficient with Dormand and Prince: where a motion has no Taylor series, the
 * reference in long double is held against it. N is the number of states.
 * Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, 2nd ed., section II.9.
 */
#define ROWS 8
#define FOR for (int i = 0; i < N; ++i)

void symrot_extrapolation(double t, double stop, long steps, double *state, const double *p)
{
    const double h = (stop - t)/steps;
    double table[ROWS][N], first[N], rate[N], before[N], y[N];
    for (long n = 0; n < steps; ++n) {
        const double now = t + n*h;
        symrot_rates(now, state, p, first);
        for (int row = 0; row < ROWS; ++row) {
            const int parts = 2*(row + 1);
            const double step = h/parts;
            FOR before[i] = state[i];
            FOR y[i] = state[i] + step*first[i];
            for (int part = 1; part < parts; ++part) {
                symrot_rates(now + part*step, y, p, rate);
                FOR {
                    const double next = before[i] + 2.0*step*rate[i];
                    before[i] = y[i];
                    y[i] = next;
                }
            }
            /* Aitken and Neville in the square of the substep, from the newest row back */
            FOR {
                double better = y[i];
                for (int column = 0; column < row; ++column) {
                    const int other = 2*(row - column);
                    const double ratio = (double)(parts*parts)/(other*other);
                    const double kept = table[column][i];
                    table[column][i] = better;
                    better += (better - kept)/(ratio - 1.0);
                }
                table[row][i] = better;
            }
        }
        FOR state[i] = table[ROWS - 1][i];
    }
}
