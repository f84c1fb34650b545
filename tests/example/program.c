/* A program of one's own that takes kernels from generated/c: C99 and C++17, all warnings errors. */
#include <math.h>
#include <stdio.h>

#include "euler_zyx_body_rates.h"
#include "heavy_top.h"
#include "quaternion_dcm.h"

enum { SAMPLES = 700 };

static double angles[3*SAMPLES], omega[3*SAMPLES], rates[3*SAMPLES];

static int differs(double a, double b) { return !(fabs(a - b) <= 4e-15*(1.0 + fabs(b))); }

int main(void)
{
    const double half = sqrt(0.5);
    const double q[4] = {half, 0.0, 0.0, half}; /* a quarter turn about z takes x to y */
    const float qf[4] = {(float)half, 0.0f, 0.0f, (float)half};
    double dcm[9];
    float dcmf[9];
    symrot_quaternion_dcm(q, dcm);
    symrot_quaternion_dcmf(qf, dcmf);
    if (differs(dcm[3], 1.0) || differs(dcm[0], 0.0) || !(fabsf(dcmf[3] - 1.0f) <= 2e-7f))
        return puts("quaternion_dcm: expected a quarter turn"), 1;

    for (size_t k = 0; k < SAMPLES; ++k) {
        angles[k] = 0.1;
        angles[SAMPLES + k] = 0.002*(double)k - 0.7;
        angles[2*SAMPLES + k] = k == 600 ? 1e9 : 0.3*(double)k; /* one angle is beyond symrot_math.h */
        for (size_t i = 0; i < 3; ++i)
            omega[i*SAMPLES + k] = 1.0 + (double)i;
    }
    symrot_euler_zyx_body_rates_batch(SAMPLES, angles, omega, rates);
    for (size_t k = 0; k < SAMPLES; ++k) {
        const double one[3] = {angles[k], angles[SAMPLES + k], angles[2*SAMPLES + k]};
        const double turning[3] = {omega[k], omega[SAMPLES + k], omega[2*SAMPLES + k]};
        double expected[3];
        symrot_euler_zyx_body_rates(one, turning, expected);
        for (size_t i = 0; i < 3; ++i)
            if (differs(rates[i*SAMPLES + k], expected[i]))
                return printf("euler_zyx_body_rates: sample %u differs\n", (unsigned)k), 1;
    }

    const double inertia[3] = {1.0, 1.0, 0.5}, center[3] = {0.0, 0.0, 0.2}, still[3] = {0.0, 0.0, 0.0};
    double domega[3], dq[4];
    symrot_heavy_top(inertia, 9.81, center, still, q, domega, dq);
    if (differs(domega[0], 0.0) || differs(domega[1], 0.0) || differs(dq[0], 0.0))
        return puts("heavy_top: expected no torque on an upright top"), 1;
    puts("kernels agree");
    return 0;
}
