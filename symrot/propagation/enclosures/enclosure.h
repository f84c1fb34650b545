/*
 * Limit of a step: an enclosure (bounds of the rates on complex discs) proves that the step misses no feature of them.
 *
 * Included after disc.h and the text of symrot.codegen.enclosure.terms, which defines
 *     symrot_deviations                   largest deviations of the enclosed terms from a constant on discs
 *     symrot_reaches, SYMROT_REACHES      radii of the discs, in steps, and the share of a deviation that a step misses
 *     symrot_encloses, SYMROT_DEPENDS     whether the enclosed terms depend on a state, and on any
 *     symrot_borders                      edges of the blocks of states, SYMROT_BORDERS blocks
 * The stepper defines before
 *     symrot_path                         the polynomials that the states follow in a step
 *     symrot_radii                        void (symrot_path path, double part, double *radius): how far the states
 *                                         deviate on the disc with that part of their unit of time as radius
 *
 * With deviations of at most D on the disc of radius rho = reach*h, coefficient n of the enclosed terms is at most
 * D/rho^n (Cauchy). States that follow them to order N have an error of at most h D reach^-N/((N + 1)(1 - 1/reach)).
 */

/* Return a bound of the error by which a step misses the enclosed terms, divided by the allowed error. */
static SYMROT_APART double symrot_excess(symrot_path path, double t, double unit, double size, int k, const double *y,
    const double *allowed, const double *p)
{
    const double reach = symrot_reaches[k][0]*size, share = symrot_reaches[k][1]*size;
    double radius[SYMROT_STATES], deviation[SYMROT_STATES], worst = 0.0;
    if (SYMROT_DEPENDS) symrot_radii(path, reach/fabs(unit), radius);
    symrot_deviations(t, reach, 1.0/symrot_reaches[k][1], y, radius, p, deviation);
    for (int b = 0; b < SYMROT_BORDERS; ++b)
        for (int i = symrot_borders[b]; i < symrot_borders[b + 1]; ++i) {
            const double lack = share*deviation[i];
            if (!(lack < INFINITY)) return INFINITY;  /* infinite or not a number */
            if (lack/allowed[b] > worst) worst = lack/allowed[b];
            if (b + 1 < SYMROT_BORDERS && size*lack/allowed[b + 1] > worst)  /* rates change the attitude */
                worst = size*lack/allowed[b + 1];
        }
    return worst;
}

/*
 * Return the longest step from t, at most h and with its sign, whose error is proven to be at most the allowed one.
 *
 * in      path     states as polynomials of the time since t in that unit
 * in      y        the states at t
 * in      allowed  error allowed in the step, per block
 * in,out  best     the disc that gave the best bound in the last step; its neighbours are tried if it does not suffice
 */
static SYMROT_APART double symrot_followed(symrot_path path, double t, double unit, double h, const double *y,
    const double *allowed, const double *p, int64_t *best)
{
    while (fabs(h) > 1e-300) {
        const int here = (int)*best;
        double least = symrot_excess(path, t, unit, fabs(h), here, y, allowed, p);
        for (int k = here - 1; k <= here + 1 && !(least <= 1.0); k += 2)
            if (k >= 0 && k < SYMROT_REACHES) {
                const double excess = symrot_excess(path, t, unit, fabs(h), k, y, allowed, p);
                if (excess < least) {
                    least = excess;
                    *best = k;
                }
            }
        if (least <= 1.0) break;
        if (least == INFINITY && here > 0) *best = here - 1;  /* a pole in every disc: try smaller discs next */
        const double factor = 0.9*pow(least, -1.0/(SYMROT_ENCLOSED_ORDER + 1));
        h *= factor > 0.3 ? (factor < 0.9 ? factor : 0.9) : 0.3;
    }
    return h;
}
