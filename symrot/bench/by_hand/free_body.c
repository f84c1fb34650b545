/* Free body in principal axes by hand: omega (rad/s, body axes), quaternion; p = (B - C)/A, (C - A)/B, (A - B)/C. */
static inline void symrot_free_body(double t, const double y[7], const double p[3], double dy[7])
{
    const double w1 = y[0], w2 = y[1], w3 = y[2], q0 = y[3], q1 = y[4], q2 = y[5], q3 = y[6];
    const double h1 = 0.5*w1, h2 = 0.5*w2, h3 = 0.5*w3;

    (void)t;
    dy[0] = p[0]*w2*w3;
    dy[1] = p[1]*w3*w1;
    dy[2] = p[2]*w1*w2;
    dy[3] = -q1*h1 - q2*h2 - q3*h3;
    dy[4] = q0*h1 + q2*h3 - q3*h2;
    dy[5] = q0*h2 + q3*h1 - q1*h3;
    dy[6] = q0*h3 + q1*h2 - q2*h1;
}
