/*
 * A torque without a formula, added to the emitted rates: a function of time, angular velocity and attitude, or a
 * table.
 *
 * Included after the emitted kernel symrot_rates of omega_1..3, q0..q3, with SYMROT_OWN parameters. The parameters of
 * the torque follow, see the enum below. Pointers are passed as the bits of doubles, so that there are no globals. C99
 * that is also valid C++.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Write the torque in N m; return 0, or another number to stop the motion. */
typedef int (*symrot_torque)(double t, const double omega[3], const double quaternion[4], double torque[3], void *user);

enum { SYMROT_FUNCTION = SYMROT_OWN, SYMROT_USER, SYMROT_IN_SPACE, SYMROT_INVERSE, SYMROT_ALL = SYMROT_INVERSE + 9 };

#if defined(_WIN32)
__declspec(dllexport)
#endif
int symrot_table_torque(double t, const double *omega, const double *quaternion, double *torque, void *user);

/*
 * Evaluate piecewise cubics. user: number of pieces m, m + 1 edges, then for each piece four coefficients of each
 * component, the highest power first, in the time since its first edge. Outside, the first or the last piece continues.
 */
int symrot_table_torque(double t, const double *omega, const double *quaternion, double *torque, void *user)
{
    const double *edges = (const double *)user + 1, *c;
    int64_t low = 0, high = (int64_t)edges[-1];
    const int64_t pieces = high;
    (void)omega;
    (void)quaternion;
    while (high - low > 1) {
        const int64_t middle = (low + high)/2;
        if (edges[middle] <= t) low = middle;
        else high = middle;
    }
    c = edges + pieces + 1 + 12*low;
    t -= edges[low];
    for (int i = 0; i < 3; ++i, c += 4) torque[i] = ((c[0]*t + c[1])*t + c[2])*t + c[3];
    return 0;
}

static inline void symrot_driven(double t, const double *y, const double *p, double *dy)
{
    symrot_torque function;
    void *user;
    memcpy(&function, p + SYMROT_FUNCTION, sizeof function);
    memcpy(&user, p + SYMROT_USER, sizeof user);
    symrot_rates(t, y, p, dy);
    /* A C function may leave components zero; a function in Python, which has `user`, fails if it writes nothing. */
    double torque[3] = {0.0, 0.0, 0.0};
    if (user != NULL) torque[0] = torque[1] = torque[2] = NAN;
    if (function(t, y, y + 3, torque, user)) torque[0] = torque[1] = torque[2] = NAN;
    if (p[SYMROT_IN_SPACE] != 0.0) {  /* v_b = v + 2 q0 (v x u) + 2 (v x u) x u, u the vector part */
        const double *u = y + 4, *v = torque;
        const double a[3] = {v[1]*u[2] - v[2]*u[1], v[2]*u[0] - v[0]*u[2], v[0]*u[1] - v[1]*u[0]};
        const double b[3] = {a[1]*u[2] - a[2]*u[1], a[2]*u[0] - a[0]*u[2], a[0]*u[1] - a[1]*u[0]};
        for (int i = 0; i < 3; ++i) torque[i] += 2.0*(y[3]*a[i] + b[i]);
    }
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) dy[i] += p[SYMROT_INVERSE + 3*i + j]*torque[j];
}
