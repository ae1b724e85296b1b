/* Force and stiffness of a cylindrical roller bearing, the algorithm of bearingjax.

The yardstick of single_call.py. Same mathematics as `BearingElement.evaluate` with
linearised kinematics, `ContactMapped` or `Midpoint` quadrature, `TrustRegionNewton` and no ribs,
written as a C programmer would for one bearing at a time: an open raceway is left after
one comparison, an open roller after two; edges that lie at the roller's end are not
searched for; Newton loops on the edges end when they have converged; the last
evaluation of the equilibrium is reused; and since only the difference of both rings
counts, 3 and not 6 ring freedoms are condensed and one block of 6 x 6 is summed.

C99 and libm. Made for

    cc -std=c99 -O3 -march=native -fopenmp-simd -fno-math-errno -fno-trapping-math

No -ffast-math: -fopenmp-simd only obeys the `omp simd` lines (sums over nodes may be
taken in any order; no threads), the other two let sqrt and selections vectorise and
change no result. SI units: m, N, rad.
*/

#define _POSIX_C_SOURCE 200809L

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#ifndef POINTS
#define POINTS 32 /* nodes per raceway */
#endif
#ifndef SCAN
#define SCAN 25 /* fixed points on which the loaded zone is looked for */
#endif
#ifndef MIDPOINT
#define MIDPOINT 0 /* 1: equal slices instead; the scan points are their middles */
#endif
#define CLIMB 4         /* most Newton steps to the maximum of the approach */
#define REFINE 6        /* most Newton steps to an edge of the loaded zone */
#define ENOUGH 1e-9     /* Newton step after which the next would be below round-off */
#define MAX_STEPS 100   /* most trust-region steps */
#define TOLERANCE 1e-13 /* force out of balance, relative to the contact loads */
#define UNBALANCED 0.03 /* a loose roller's contacts do not cancel to this part */
#define LOOSE 1e2       /* load of a loose roller against the guide's */

typedef struct {
    double n_rollers, constant, half_length, diameter, crown_radius, gap, guide;
    double pitch_radius, ratio, first_azimuth;
    double raceway_radius[2]; /* crown of outer and inner raceway, 0: straight */
} Numbers;

/* What depends on the design alone. */
typedef struct {
    Numbers n;
    double tau[POINTS], w0[POINTS], w1[POINTS], w2[POINTS]; /* w, w tau, w tau^2 */
    double at[SCAN], fixed[2][SCAN]; /* scan points, drops there [m] */
    double by_ring[4][3]; /* d(approach)/d(outer - inner) */
    double by_x[4][3];    /* d(approach)/d(roller unknowns) */
} Design;

/* Energy of one raceway contact and its derivatives by (a, b). */
typedef struct {
    double energy, load[2], stiffness[3]; /* aa, ab, bb */
} Response;

/* One evaluation of a roller's energy; h is (tt, tm, mm, tx, mx, xx) packed. */
typedef struct {
    Response raceway[2];
    double value, size, g[3], h[6], scale, noise;
    int loose;
} Evaluation;

static const int PACKED[3][3] = {{0, 1, 3}, {1, 2, 4}, {3, 4, 5}};

static inline double square(double x) { return x * x; }

static inline double norm3(const double *x)
{
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

/* x^(1/9) of a positive normal number: seed from the bits, two steps of the series. */
static inline double ninth_root(double x)
{
    const double magic = (1023.0 - 0.0450466) * (10.0 / 9.0) * 1048576.0;
    uint64_t bits;
    double y;
    memcpy(&bits, &x, 8);
    int32_t high = (int32_t)(bits >> 32);
    int32_t seed = (int32_t)(magic - high * (1.0 / 9.0));
    bits = (uint64_t)(uint32_t)seed << 32;
    memcpy(&y, &bits, 8);
    double y3 = y * y * y, e = 1.0 - x * (y3 * y3 * y3);
    y *= 1.0 + e * (1.0 / 9 + e * (5.0 / 81 + e * (95.0 / 2187
         + e * (665.0 / 19683 + e * (4921.0 / 177147)))));
    y3 = y * y * y;
    e = 1.0 - x * (y3 * y3 * y3);
    y *= 1.0 + e * (1.0 / 9 + e * (5.0 / 81 + e * (95.0 / 2187)));
    double y2 = y * y, y4 = y2 * y2;
    return x * (y4 * y4);
}

/* One raceway contact: what its approach depends on. */
typedef struct {
    const Design *d;
    const double *fixed; /* drop at the scan points [m] */
    double raceway;      /* crown radius of the raceway, 0: straight [m] */
    double a, b;         /* approach at xi = 0, its part from tilt at xi = 1 [m] */
} Contact;

/* Drop of a circular crown of radius r at s from the middle [m]. */
static inline double crown(double s, double r)
{
    return s * s / (r + sqrt(r * r - s * s));
}

/* Take a crown from the approach f and its derivatives by xi. */
static inline void take_crown(double s, double r, double length, double *f)
{
    double root = sqrt(r * r - s * s), inverse = 1.0 / root, slope = s * inverse;
    f[0] -= s * s / (r + root);
    f[1] -= length * slope;
    f[2] -= length * length * inverse * (1.0 + slope * slope);
}

/* a + b xi - drop, its first and its second derivative. */
static inline void approach(const Contact *c, double xi, double *f)
{
    const double length = c->d->n.half_length, s = length * xi;
    f[0] = c->a + c->b * xi;
    f[1] = c->b;
    f[2] = 0.0;
    take_crown(s, c->d->n.crown_radius, length, f);
    if (c->raceway > 0) take_crown(s, c->raceway, length, f);
}

/* The zero between `inside` (positive) and `outside`, from a first guess. */
static double edge(
    const Contact *c, double x, double inside, double outside, double width)
{
    for (int pass = 0; pass < REFINE; pass++) {
        double f[3];
        if (!((x - inside) * (x - outside) <= 0)) x = 0.5 * (inside + outside);
        approach(c, x, f);
        double newton = x - f[0] / (f[1] == 0 ? 1.0 : f[1]);
        if (f[0] > 0) inside = x; else outside = x;
        double step = fabs(newton - x);
        x = newton;
        if (step <= ENOUGH * width) break;
    }
    return (x - inside) * (x - outside) <= 0 ? x : outside;
}

/* Newton steps to the maximum of the approach between two scan points. */
static double climb(const Contact *c, double top, double lo, double hi)
{
    for (int pass = 0; pass < CLIMB; pass++) {
        double f[3];
        approach(c, top, f);
        if (!(f[2] < 0)) break;
        double next = fmin(fmax(top - f[1] / f[2], lo), hi), step = fabs(next - top);
        top = next;
        if (step <= ENOUGH) break;
    }
    return top;
}

/* Loaded interval of a raceway; 0 if there is none. */
static int loaded(const Contact *c, double *left, double *right)
{
    const Design *d = c->d;
    const double a = c->a, b = c->b, *fixed = c->fixed;
    double f[SCAN], at_top[3], best = -INFINITY;
    int last = SCAN - 1, peak = 0, first, final;
    *left = -1.0;
    *right = 1.0;
    if (a + fabs(b) <= 0) return 0;
    if (MIDPOINT) return 1;
    int at_start = a - b - fixed[0] > 0, at_end = a + b - fixed[last] > 0;
    if (at_start && at_end) return 1;
    for (int i = 0; i < SCAN; i++) f[i] = a + b * d->at[i] - fixed[i];
    for (int i = 0; i < SCAN; i++) best = f[i] > best ? f[i] : best;
    while (f[peak] < best) peak++;
    while (peak < last && f[peak + 1] == best) peak++;
    double lo = d->at[peak > 0 ? peak - 1 : 0];
    double hi = d->at[peak < last ? peak + 1 : last];
    double middle = climb(c, d->at[peak], lo, hi);
    approach(c, middle, at_top);
    if (!(at_top[0] > best)) {
        middle = d->at[peak];
        approach(c, middle, at_top);
    }
    if (at_top[0] <= 0) return 0;
    double width = sqrt(2.0 * at_top[0] / (at_top[2] < 0 ? -at_top[2] : 1.0));
    if (!at_start) {
        for (first = 0; first < SCAN && !(f[first] > 0); first++) {}
        double inside = first < SCAN ? fmin(middle, d->at[first]) : middle;
        while (first > 0 && !(first < SCAN && d->at[first] < inside)) first--;
        *left = edge(c, middle - width, inside, d->at[first], width);
    }
    if (!at_end) {
        for (final = last; final >= 0 && !(f[final] > 0); final--) {}
        double inside = final >= 0 ? fmax(middle, d->at[final]) : middle;
        while (final < last && !(final >= 0 && d->at[final] > inside)) final++;
        *right = edge(c, middle + width, inside, d->at[final], width);
    }
    return 1;
}

/* Energy, load and stiffness over a loaded interval, from one pass over the nodes.

`crowned` (of the raceway) is a constant at each call: two copies of the loop. */
static inline void integrate(
    const Contact *c, double left, double right, int crowned, Response *out)
{
    const Design *d = c->d;
    double e0 = 0, p0 = 0, p1 = 0, k0 = 0, k1 = 0, k2 = 0;
    const double middle = 0.5 * (left + right), half = 0.5 * (right - left);
    const double a = c->a, b = c->b, r = d->n.crown_radius, other = c->raceway;
    const double length = d->n.half_length;
#pragma omp simd reduction(+ : e0, p0, p1, k0, k1, k2)
    for (int i = 0; i < POINTS; i++) {
        double xi = middle + half * d->tau[i], s = length * xi;
        double x = a + b * xi;
        if (MIDPOINT) x -= c->fixed[i];
        else x -= crown(s, r);
        if (crowned && !MIDPOINT) x -= crown(s, other);
        double base = x > DBL_MIN ? x : DBL_MIN;
        double root = ninth_root(base);
        root = x > 0 ? root : 0.0;
        double load = x * root;
        e0 += d->w0[i] * (x * load);
        p0 += d->w0[i] * load;
        p1 += d->w1[i] * load;
        k0 += d->w0[i] * root;
        k1 += d->w1[i] * root;
        k2 += d->w2[i] * root;
    }
    const double scale = d->n.constant * length * half, stiff = scale * (10.0 / 9.0);
    out->energy = scale * (9.0 / 19.0) * e0;
    out->load[0] = scale * p0;
    out->load[1] = scale * (middle * p0 + half * p1);
    out->stiffness[0] = stiff * k0;
    out->stiffness[1] = stiff * (middle * k0 + half * k1);
    out->stiffness[2] = stiff
        * (middle * middle * k0 + 2.0 * middle * half * k1 + half * half * k2);
}

/* Energy of one raceway contact and its derivatives. */
static void response(const Design *d, int raceway, const double *ab, Response *out)
{
    const Contact c = {
        d, d->fixed[raceway], d->n.raceway_radius[raceway], ab[0], ab[1]};
    double left, right;
    if (!loaded(&c, &left, &right)) memset(out, 0, sizeof *out);
    else if (c.raceway > 0) integrate(&c, left, right, 1, out);
    else integrate(&c, left, right, 0, out);
}

/* K rows of one raceway: stiffness (2 x 2) times two rows of derivatives (2 x 3). */
static inline void times_rows(
    const double *k, const double (*rows)[3], double out[2][3])
{
    for (int j = 0; j < 3; j++) {
        out[0][j] = k[0] * rows[0][j] + k[1] * rows[1][j];
        out[1][j] = k[1] * rows[0][j] + k[2] * rows[1][j];
    }
}

/* Energy of a roller and its derivatives by x, with what ends the solve. */
static void evaluate(
    const Design *d, const double *start, double magnitude, const double *x,
    Evaluation *out)
{
    const double guide = d->n.guide;
    const double distance = norm3(x);
    double pull[3] = {0, 0, 0}, h[6] = {0, 0, 0, 0, 0, 0}, load = 0;
    out->value = 0.5 * guide * square(distance);
    for (int k = 0; k < 2; k++) {
        const double(*rows)[3] = &d->by_x[2 * k];
        double ab[2], moved[2][3];
        for (int i = 0; i < 2; i++) {
            const double *row = rows[i];
            ab[i] = start[2 * k + i] + row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
        }
        Response *contact = &out->raceway[k];
        response(d, k, ab, contact);
        if (!(contact->load[0] != 0)) continue;
        out->value += contact->energy;
        load += contact->load[0];
        times_rows(contact->stiffness, rows, moved);
        for (int i = 0; i < 3; i++) {
            pull[i] += rows[0][i] * contact->load[0] + rows[1][i] * contact->load[1];
            for (int j = 0; j <= i; j++)
                h[PACKED[i][j]] += rows[0][i] * moved[0][j] + rows[1][i] * moved[1][j];
        }
    }
    for (int i = 0; i < 3; i++) out->g[i] = pull[i] + guide * x[i];
    memcpy(out->h, h, sizeof h);
    out->h[0] += guide;
    out->h[2] += guide;
    out->h[5] += guide;
    const double trace = out->h[0] + out->h[2] + out->h[5];
    const double size = magnitude + fabs(d->n.gap) + distance;
    const double unbalanced = square(norm3(pull));
    out->size = norm3(out->g);
    out->scale = load;
    out->noise = size * (DBL_EPSILON * trace + 1e-6 * guide);
    out->loose =
        unbalanced >= square(UNBALANCED * load) && load <= LOOSE * guide * size;
}

/* Factors L D L' of a packed symmetric 3 x 3 matrix scaled to a unit diagonal. */
typedef struct {
    double scale[3], l10, l20, l21, inverse[3];
} Factors;

static inline double lifted(double pivot)
{
    const double floor = 8.0 * DBL_EPSILON;
    return pivot < floor ? floor : pivot;
}

static void factorise(const double *h, Factors *f)
{
    const double diagonal[3] = {h[0], h[2], h[5]};
    double *s = f->scale;
    for (int i = 0; i < 3; i++)
        s[i] = diagonal[i] > DBL_MIN ? 1.0 / sqrt(diagonal[i]) : 1.0;
    double a10 = h[1] * s[0] * s[1], a20 = h[3] * s[0] * s[2], a21 = h[4] * s[1] * s[2];
    double d0 = lifted(h[0] * s[0] * s[0]);
    f->inverse[0] = 1.0 / d0;
    f->l10 = a10 * f->inverse[0];
    f->l20 = a20 * f->inverse[0];
    double d1 = lifted(h[2] * s[1] * s[1] - f->l10 * f->l10 * d0);
    f->inverse[1] = 1.0 / d1;
    f->l21 = (a21 - f->l20 * f->l10 * d0) * f->inverse[1];
    double d2 = h[5] * s[2] * s[2] - f->l20 * f->l20 * d0 - f->l21 * f->l21 * d1;
    f->inverse[2] = 1.0 / lifted(d2);
}

static inline void substitute(const Factors *f, const double *rhs, double *x)
{
    double y0 = rhs[0] * f->scale[0];
    double y1 = rhs[1] * f->scale[1] - f->l10 * y0;
    double y2 = rhs[2] * f->scale[2] - f->l20 * y0 - f->l21 * y1;
    double x2 = y2 * f->inverse[2];
    double x1 = y1 * f->inverse[1] - f->l21 * x2;
    double x0 = y0 * f->inverse[0] - f->l10 * x1 - f->l20 * x2;
    x[0] = x0 * f->scale[0];
    x[1] = x1 * f->scale[1];
    x[2] = x2 * f->scale[2];
}

/* p' H p of a packed symmetric matrix. */
static inline double form(const double *h, const double *p)
{
    return h[0] * p[0] * p[0] + h[2] * p[1] * p[1] + h[5] * p[2] * p[2]
        + 2.0 * (h[1] * p[0] * p[1] + h[3] * p[0] * p[2] + h[4] * p[1] * p[2]);
}

static inline double dot3(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Step of Newton's method on H + shift, no longer than the radius. */
static double newton_step(const Evaluation *now, double radius, double *p)
{
    Factors factors;
    double h[6];
    memcpy(h, now->h, sizeof h);
    double trace = h[0] + h[2] + h[5];
    double shift = now->size / radius + DBL_EPSILON * trace / 3.0;
    h[0] += shift;
    h[2] += shift;
    h[5] += shift;
    factorise(h, &factors);
    substitute(&factors, now->g, p);
    double length = norm3(p), part = length > radius ? -radius / length : -1.0;
    for (int i = 0; i < 3; i++) p[i] *= part;
    return -part * length;
}

/* Equilibrium of one roller from x, where it is left; returns the evaluations
after the first. */
static int solve_roller(
    const Design *d, const double *start, double magnitude, double radius, double *x,
    Evaluation *state)
{
    Evaluation buffer, *now = state, *new = &buffer;
    int steps = 0, stalled = 0;
    evaluate(d, start, magnitude, x, now);
    while (!now->loose && now->size > TOLERANCE * now->scale + now->noise
           && steps < MAX_STEPS && !stalled) {
        double p[3], there[3];
        double length = newton_step(now, radius, p);
        for (int i = 0; i < 3; i++) there[i] = x[i] + p[i];
        evaluate(d, start, magnitude, there, new);
        double slope = dot3(now->g, p), predicted = slope + 0.5 * form(now->h, p);
        double actual = new->value - now->value;
        steps++;
        if (actual <= 1e-4 * slope || new->size <= 0.5 * now->size) {
            int good = actual <= 0.7 * predicted || new->size <= 0.25 * now->size;
            if (good) radius = fmax(radius, 6.0 * length);
            Evaluation *old = now;
            now = new;
            new = old;
            memcpy(x, there, sizeof there);
        } else {
            double bend = fmax(form(new->h, p), DBL_MIN);
            double part = 1.0 - dot3(new->g, p) / bend;
            radius = length * fmin(fmax(part, 0.1), 0.9);
            stalled = length <= 4.0 * DBL_EPSILON * norm3(x);
        }
    }
    if (now != state) *state = *now;
    return steps;
}

/* Force f (3) and stiffness k (3, 3) of a solved roller by outer - inner. */
static void condense(const Design *d, const Evaluation *e, double *f, double k[3][3])
{
    double coupling[3][3], moved[3];
    Factors factors;
    memset(f, 0, 3 * sizeof *f);
    memset(k, 0, 9 * sizeof **k);
    memset(coupling, 0, sizeof coupling);
    for (int r = 0; r < 2; r++) {
        const double(*ring)[3] = &d->by_ring[2 * r];
        const double(*rows)[3] = &d->by_x[2 * r];
        const Response *c = &e->raceway[r];
        double half[2][3];
        times_rows(c->stiffness, ring, half);
        for (int i = 0; i < 3; i++) {
            f[i] += ring[0][i] * c->load[0] + ring[1][i] * c->load[1];
            for (int j = 0; j < 3; j++) {
                k[i][j] += ring[0][i] * half[0][j] + ring[1][i] * half[1][j];
                coupling[j][i] += rows[0][i] * half[0][j] + rows[1][i] * half[1][j];
            }
        }
    }
    factorise(e->h, &factors);
    for (int j = 0; j < 3; j++) {
        substitute(&factors, coupling[j], moved);
        for (int i = 0; i < 3; i++) k[i][j] -= dot3(coupling[i], moved);
    }
}

/* Add a roller's share, first to the section (u, v, theta), then to the ring (6). */
static void add_share(
    const Design *d, double c, double s, const double *f, double k[3][3],
    double *force, double stiffness[6][6])
{
    const double r = d->n.pitch_radius;
    /* Roller axes from the section: (u - R theta, v, theta). */
    double g[3] = {f[0], f[1], f[2] - r * f[0]}, m[3][3];
    for (int i = 0; i < 3; i++) {
        m[i][0] = k[i][0];
        m[i][1] = k[i][1];
        m[i][2] = k[i][2] - r * k[i][0];
    }
    for (int j = 0; j < 3; j++) m[2][j] -= r * m[0][j];
    const int part[5] = {1, 1, 0, 2, 2};
    const double by[5] = {c, s, 1.0, -s, c};
    for (int i = 0; i < 5; i++) {
        force[i] += by[i] * g[part[i]];
        for (int j = 0; j <= i; j++)
            stiffness[i][j] += by[i] * by[j] * m[part[i]][part[j]];
    }
}

/* Size of the displacements from which the ring motions come [m]. */
static double magnitude_of(const Design *d, const double *q)
{
    double shift = 0, tilt = 0;
    for (int ring = 0; ring < 12; ring += 6) {
        for (int i = 0; i < 3; i++) shift = fmax(shift, fabs(q[ring + i]));
        for (int i = 3; i < 5; i++) tilt = fmax(tilt, fabs(q[ring + i]));
    }
    return shift + d->n.pitch_radius * tilt;
}

/* Ring force (12) [N, N m] and stiffness (12, 12) from the sums over the rollers. */
static void spread(
    const double *sum, double block[6][6], double *force, double *stiffness)
{
    for (int i = 0; i < 6; i++) {
        force[i] = sum[i];
        force[6 + i] = -sum[i];
        for (int j = 0; j < 6; j++) {
            double value = j <= i ? block[i][j] : block[j][i];
            stiffness[12 * i + j] = stiffness[12 * (i + 6) + j + 6] = value;
            stiffness[12 * i + j + 6] = stiffness[12 * (i + 6) + j] = -value;
        }
    }
}

/* How the rollers fared: energy, sizes of what they pass to the rings, most steps. */
typedef struct {
    double energy, magnitude;
    int steps;
} Course;

/* Where a roller was found, if it was. */
typedef struct {
    double x[3];
    int known;
} Place;

/* Force (12) and stiffness (12, 12) at ring freedoms q (12), outer then inner ring.

`places` (n_rollers) are where rollers start, and where they end; NULL: from 0. */
static void bearing(
    const Design *d, const double *q, Place *places, double *force, double *stiffness,
    Course *course)
{
    const Numbers *n = &d->n;
    const double magnitude = magnitude_of(d, q);
    const double pitch = 2.0 * acos(-1.0) / n->n_rollers;
    const double first = n->first_azimuth
        + 0.5 * ((1.0 - n->ratio) * q[11] + (1.0 + n->ratio) * q[5]);
    double y[6], sum[6] = {0}, block[6][6] = {{0}};
    memset(course, 0, sizeof *course);
    for (int i = 0; i < 6; i++) y[i] = q[i] - q[6 + i];
    for (int l = 0; l < (int)n->n_rollers; l++) {
        const double c = cos(first + l * pitch), s = sin(first + l * pitch);
        const double tilt = c * y[4] - s * y[3];
        const double between[3] = {
            y[2] - n->pitch_radius * tilt, c * y[0] + s * y[1], tilt};
        double start[4], f[3], k[3][3];
        for (int i = 0; i < 4; i++) {
            start[i] = dot3(d->by_ring[i], between) - (i % 2 ? 0.0 : n->gap);
        }
        /* Open on both raceways as it stands: loose, and nothing to solve. */
        if (start[0] + fabs(start[1]) <= 0 && start[2] + fabs(start[3]) <= 0) continue;
        const double radius = fabs(between[0]) + fabs(between[1])
            + fabs(between[2]) * n->half_length + fabs(n->gap) + 1e-6 * n->diameter;
        Evaluation state;
        double x[3] = {0, 0, 0};
        if (places && places[l].known) memcpy(x, places[l].x, sizeof x);
        int taken = solve_roller(d, start, magnitude, radius, x, &state);
        course->steps = taken > course->steps ? taken : course->steps;
        if (places) {
            memcpy(places[l].x, x, sizeof x);
            places[l].known = !state.loose;
        }
        if (state.loose) continue;
        condense(d, &state, f, k);
        course->energy += state.value;
        course->magnitude += 2.0 * (fabs(f[0]) + fabs(f[1]));
        add_share(d, c, s, f, k, sum, block);
    }
    spread(sum, block, force, stiffness);
}

/* The same; `steps` gets the most evaluations of a roller after its first. */
void force_stiffness(
    const Design *d, const double *q, double *force, double *stiffness, int *steps)
{
    Course course;
    bearing(d, q, NULL, force, stiffness, &course);
    *steps = course.steps;
}

/* The same at many ring freedoms (count, 12). */
void batch(
    int count, const Design *d, const double *q, double *force, double *stiffness)
{
    int steps;
    for (int i = 0; i < count; i++)
        force_stiffness(d, q + 12 * i, force + 12 * i, stiffness + 144 * i, &steps);
}

int design_size(void) { return (int)sizeof(Design); }

/* Fill in a design from its numbers, nodes and weights (POINTS), scan points (SCAN). */
void prepare(
    const Numbers *numbers, const double *tau, const double *weight, const double *at,
    Design *d)
{
    const double half = numbers->half_length;
    /* Approach change = row (ring - roller), in roller axes. */
    const double rows[4][3] = {{0, -1, 0}, {0, 0, -half}, {0, 1, 0}, {0, 0, half}};
    d->n = *numbers;
    for (int i = 0; i < POINTS; i++) {
        d->tau[i] = tau[i];
        d->w0[i] = weight[i];
        d->w1[i] = weight[i] * tau[i];
        d->w2[i] = weight[i] * tau[i] * tau[i];
    }
    for (int i = 0; i < SCAN; i++) {
        d->at[i] = at[i];
        for (int k = 0; k < 2; k++) {
            const double s = half * at[i], r = numbers->raceway_radius[k];
            d->fixed[k][i] = crown(s, numbers->crown_radius);
            if (r > 0) d->fixed[k][i] += crown(s, r);
        }
    }
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 3; j++) {
            d->by_ring[i][j] = (i < 2 ? 0.5 : -0.5) * rows[i][j];
            d->by_x[i][j] = -rows[i][j] / (j == 2 ? half : 1.0);
        }
}

/* Seconds that n calls take, by this side's clock. */
double repeat(
    int n, const Design *d, const double *q, double *force, double *stiffness,
    int *steps)
{
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    for (int i = 0; i < n; i++) force_stiffness(d, q, force, stiffness, steps);
    clock_gettime(CLOCK_MONOTONIC, &end);
    return (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (end.tv_nsec - begin.tv_nsec);
}
