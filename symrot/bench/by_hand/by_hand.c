/*
 * What a textbook writes: classical RK4 with a fixed step, the quaternion renormalised after each step or left alone.
 * Follows the text of symrot_rates; N is the number of states, the last four of them the quaternion. For
 * `symrot bench --stability`.
 */
#include <math.h>

#define FOR for (int i = 0; i < N; ++i)

void symrot_rk4(double t, double stop, long steps, int normalised, double *y, const double *p)
{
    const double h = (stop - t)/steps;
    double k1[N], k2[N], k3[N], k4[N], z[N];
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
        if (normalised) {
            const double *const q = y + N - 4;
            const double size = sqrt(q[0]*q[0] + q[1]*q[1] + q[2]*q[2] + q[3]*q[3]);
            for (int i = N - 4; i < N; ++i) y[i] /= size;
        }
    }
}
