/* Where the inner ring goes under load, the algorithm of bearingjax.

The yardstick of load_solve_throughput.py: `solve_load` of a cylindrical roller bearing
without ribs, outer ring fixed, ux, uy, gx and gy of the inner ring free. The same
trust-region Newton method as `TrustRegionNewton.search`, from first contact along the
load and by tens of the load, or from the solution before; every evaluation starts the
rollers where they were, and the last one is the answer. SI units: m, N, rad. */

#include "c_loop.c"

#define FREE 4
#define MOST_ROLLERS 64
#define MOST_LOAD_STEPS 200
#define LOAD_TOLERANCE 1e-11

static const int FREEDOM[FREE] = {0, 1, 3, 4};

/* V - pull·y and its derivatives, unknowns in metres. */
typedef struct {
    double value, g[FREE], h[FREE][FREE], scale, noise;
    double force[12], stiffness[144];
    Place places[MOST_ROLLERS];
} Sum;

static double dot(const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < FREE; i++) sum += a[i] * b[i];
    return sum;
}

static double norm(const double *a) { return sqrt(dot(a, a)); }

static double quadratic(double h[FREE][FREE], const double *p)
{
    double sum = 0;
    for (int i = 0; i < FREE; i++) sum += p[i] * dot(h[i], p);
    return sum;
}

static double trace(double h[FREE][FREE])
{
    double sum = 0;
    for (int i = 0; i < FREE; i++) sum += h[i][i];
    return sum;
}

/* x = (h + shift D)^-1 rhs by L D L' of the matrix scaled to a unit diagonal; D: its
   diagonal over the largest element, at least 0.03. */
static void solve_shifted(
    double h[FREE][FREE], double shift, const double *rhs, double *x)
{
    double s[FREE], l[FREE][FREE], d[FREE], own[FREE], stiffest = DBL_MIN;
    for (int i = 0; i < FREE; i++) stiffest = fmax(stiffest, h[i][i]);
    for (int i = 0; i < FREE; i++) {
        own[i] = h[i][i] + shift * fmin(fmax(h[i][i] / stiffest, 0.03), 1.0);
        double diagonal = own[i];
        s[i] = diagonal > DBL_MIN ? 1.0 / sqrt(diagonal) : 1.0;
    }
    for (int j = 0; j < FREE; j++) {
        d[j] = own[j] * s[j] * s[j];
        for (int k = 0; k < j; k++) d[j] -= l[j][k] * l[j][k] * d[k];
        d[j] = lifted(d[j]);
        for (int i = j + 1; i < FREE; i++) {
            l[i][j] = h[i][j] * s[i] * s[j];
            for (int k = 0; k < j; k++) l[i][j] -= l[i][k] * l[j][k] * d[k];
            l[i][j] /= d[j];
        }
    }
    for (int i = 0; i < FREE; i++) {
        x[i] = rhs[i] * s[i];
        for (int k = 0; k < i; k++) x[i] -= l[i][k] * x[k];
    }
    for (int i = FREE - 1; i >= 0; i--) {
        x[i] /= d[i];
        for (int k = i + 1; k < FREE; k++) x[i] -= l[k][i] * x[k];
    }
    for (int i = 0; i < FREE; i++) x[i] *= s[i];
}

/* One evaluation at y [m]; `out->places` are where the rollers start and end. */
static void sum_at(const Design *d, const double *y, const double *by, Sum *out)
{
    double q[12] = {0};
    Course course;
    for (int i = 0; i < FREE; i++) q[6 + FREEDOM[i]] = by[i] * y[i];
    bearing(d, q, out->places, out->force, out->stiffness, &course);
    for (int i = 0; i < FREE; i++) {
        out->g[i] = by[i] * out->force[6 + FREEDOM[i]];
        for (int j = 0; j < FREE; j++)
            out->h[i][j] = by[i] * by[j]
                * out->stiffness[12 * (6 + FREEDOM[i]) + 6 + FREEDOM[j]];
    }
    out->value = course.energy;
    out->scale = course.magnitude;
    out->noise = DBL_EPSILON * (course.magnitude + trace(out->h) * norm(y));
}

/* Gradient and size of V - factor pull·y. */
static double pulled(const Sum *s, const double *pull, double factor, double *g)
{
    for (int i = 0; i < FREE; i++) g[i] = s->g[i] - factor * pull[i];
    return norm(g);
}

/* Solve for one load; `y` [m] is the start and gets the answer.

Returns the evaluation there, which is one of `now` and `new`. */
static const Sum *solve_load(
    const Design *d, const double *load, int warm, double *y, const double *by, Sum *now,
    Sum *new, int *taken, int *converged)
{
    const double r = d->n.pitch_radius, play = fmax(2.0 * d->n.gap, 0.0);
    const double stiff = 2.0 * d->n.half_length * d->n.constant;
    const double pressing = stiff * pow(play, 10.0 / 9);
    double pull[FREE], way[FREE], g[FREE], p[FREE], there[FREE], after[FREE];
    for (int i = 0; i < FREE; i++) pull[i] = by[i] * load[FREEDOM[i]];
    const double size_of_pull = norm(pull), known = 1e-3 * r;
    const double share = size_of_pull / (stiff * pow(known, 10.0 / 9));
    const double approach = fmin(known * pow(share, 0.8), 0.1 * r);
    const double first_radius = 1e-7 * r + play + approach;
    for (int i = 0; i < FREE; i++)
        way[i] = pull[i] / (size_of_pull > 0 ? size_of_pull : 1.0);
    double factor = 1.0, radius = first_radius, goal;
    if (!warm && size_of_pull > 0) factor = fmax(1.0, pressing / size_of_pull);
    int steps = 0, stalled = 0;
    for (int l = 0; l < (int)d->n.n_rollers; l++) now->places[l].known = 0;
    sum_at(d, y, by, now);
    pulled(now, pull, factor, g);
    double fall = -dot(g, way);
    double reach = fall > 0 && quadratic(now->h, way) * radius < fall ? radius : 0.0;
    for (;;) {
        double size = pulled(now, pull, factor, g);
        double scale = size_of_pull > 0 ? factor * size_of_pull : now->scale;
        goal = (factor > 1 ? 1e-2 : LOAD_TOLERANCE) * scale + now->noise;
        int off = size > goal && !stalled;
        if (steps >= MOST_LOAD_STEPS || norm(y) >= 8.0 * r) break;
        if (!off && factor > 1) {
            factor = fmax(0.1 * factor, 1.0);
            radius = first_radius;
            stalled = 0;
            size = pulled(now, pull, factor, g);
        } else if (!off) break;
        double shift = size / radius + DBL_EPSILON * trace(now->h) / FREE;
        solve_shifted(now->h, shift, g, p);
        double part = -fmin(1.0, radius / fmax(norm(p), DBL_MIN));
        int searching = reach > 0;
        for (int i = 0; i < FREE; i++) {
            p[i] = searching ? reach * way[i] : part * p[i];
            there[i] = y[i] + p[i];
        }
        memcpy(new->places, now->places, sizeof now->places);
        sum_at(d, there, by, new);
        double new_size = pulled(new, pull, factor, after), length = norm(p);
        double slope = dot(g, p), predicted = slope + 0.5 * quadratic(now->h, p);
        double actual = new->value - now->value - factor * dot(pull, p);
        double change = fmin(actual, dot(after, p));
        steps++;
        stalled = length <= 4.0 * DBL_EPSILON * norm(y) && new_size > 0.5 * size
            && !searching;
        reach = searching && -dot(after, way) > 0 ? 4.0 * reach : 0.0;
        if (searching || change <= 1e-4 * slope || new_size <= 0.5 * size) {
            if (change <= 0.7 * predicted || new_size <= 0.25 * size)
                radius = fmax(radius, 6.0 * length);
            Sum *old = now;
            now = new;
            new = old;
            memcpy(y, there, sizeof there);
        } else {
            double bend = fmax(quadratic(new->h, p), DBL_MIN);
            radius = length * fmin(fmax(1.0 - dot(after, p) / bend, 0.1), 0.9);
        }
    }
    *converged = pulled(now, pull, 1.0, g) <= (stalled ? 1e3 : 1.0) * goal && factor == 1;
    *taken = steps;
    return now;
}

/* Displacements (count, 12), stiffnesses (count, 12, 12), steps; returns the failures.

`neighbours`: each case starts from the solution before it. */
int sweep(
    int count, const Design *d, const double *loads, int neighbours,
    double *displacement, double *stiffness, int *steps)
{
    const double r = d->n.pitch_radius, by[FREE] = {1.0, 1.0, 1.0 / r, 1.0 / r};
    Sum pair[2];
    double y[FREE];
    int failed = 0, converged = 0;
    for (int c = 0; c < count; c++) {
        int warm = neighbours && converged;
        if (!warm) memset(y, 0, sizeof y);
        const Sum *answer = solve_load(
            d, loads + 6 * c, warm, y, by, &pair[0], &pair[1], &steps[c], &converged);
        failed += !converged;
        memset(displacement + 12 * c, 0, 12 * sizeof *displacement);
        for (int i = 0; i < FREE; i++)
            displacement[12 * c + 6 + FREEDOM[i]] = by[i] * y[i];
        memcpy(stiffness + 144 * c, answer->stiffness, 144 * sizeof *stiffness);
    }
    return failed;
}
