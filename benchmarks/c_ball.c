/* Force and stiffness of an angular contact ball bearing, the algorithm of bearingjax.

The yardstick of ball_speed.py. Same mathematics as `BearingElement.evaluate` with
linearised kinematics and rings that stand still: two contacts a ball, constants known,
`TrustRegionNewton` with the steps that follow the groove. Written as a C programmer
would for one bearing at a time: the last evaluation of the equilibrium is reused, and
one block of 6 x 6 is summed.

C99 and libm; see c_loop.c for how it is compiled. SI units: m, N, rad.
*/

#define _POSIX_C_SOURCE 200809L

#include <float.h>
#include <math.h>
#include <string.h>
#include <time.h>

#define MAX_STEPS 100
#define TOLERANCE 1e-13 /* force out of balance, relative to the contact loads */

typedef struct {
    double n_balls, first_azimuth, ratio, pitch_radius, diameter, guide, gap;
    double start[2][2]; /* groove centre to ball centre (z, r), outer, inner [m] */
    double reach[2];    /* groove radius less ball radius [m] */
    double constant[2]; /* c of Q = c approach^1.5 */
    double lever[2];    /* motion of the inner groove centre per tilt, subtracted */
    double open_side;   /* 1: a cylinder beyond the groove bottom */
} Design;

/* One evaluation of a ball; h is (zz, zr, rr), of each contact k likewise. */
typedef struct {
    double approach[2], length[2], nz[2], nr[2], mask[2], load[2], k[2][3];
    double value, g[2], h[3], size, scale, noise;
    int loose;
} Evaluation;

static inline double square(double x) { return x * x; }

static inline void contact(
    const Design *d, int k, const double *between, const double *x, Evaluation *e)
{
    const double side = k ? -0.5 : 0.5, outwards = k ? -1.0 : 1.0;
    double mz = side * between[0] + x[0], mr = side * between[1] + x[1];
    if (k) {
        mz += d->lever[0] * between[2];
        mr += d->lever[1] * between[2];
    }
    const double *s = d->start[k], reach = d->reach[k];
    double vz = s[0] + mz, r = s[1] + mr;
    int beyond = d->open_side > 0 && outwards * vz < 0;
    double z = beyond ? 0.0 : vz, sum = z * z + r * r;
    double length = sqrt(fmax(sum, DBL_MIN));
    double start2 = s[0] * s[0] + s[1] * s[1] - reach * reach;
    double change = mz * (2.0 * s[0] + mz) + mr * (2.0 * s[1] + mr);
    double difference = beyond ? sum - reach * reach : start2 + change;
    e->approach[k] = difference / (length + reach);
    e->length[k] = length;
    e->nz[k] = z / length;
    e->nr[k] = r / length;
    e->mask[k] = beyond ? 0.0 : 1.0;
}

static void evaluate(
    const Design *d, const double *between, double magnitude, const double *x,
    Evaluation *e)
{
    const double guide = d->guide, distance = sqrt(x[0] * x[0] + x[1] * x[1]);
    double pull[2] = {0, 0};
    e->value = 0.5 * guide * square(distance);
    e->h[0] = e->h[2] = guide;
    e->h[1] = e->scale = 0;
    for (int k = 0; k < 2; k++) {
        contact(d, k, between, x, e);
        double a = e->approach[k];
        if (!(a > 0)) {
            e->load[k] = e->k[k][0] = e->k[k][1] = e->k[k][2] = 0;
            continue;
        }
        double power = d->constant[k] * sqrt(a), load = power * a, rate = 1.5 * power;
        double nz = e->nz[k], nr = e->nr[k], turn = load / e->length[k];
        e->load[k] = load;
        e->value += 0.4 * load * a;
        e->scale += load;
        pull[0] += load * nz;
        pull[1] += load * nr;
        e->k[k][0] = (rate - turn) * nz * nz + turn * e->mask[k];
        e->k[k][1] = (rate - turn) * nz * nr;
        e->k[k][2] = (rate - turn) * nr * nr + turn;
        for (int i = 0; i < 3; i++) e->h[i] += e->k[k][i];
    }
    e->g[0] = pull[0] + guide * x[0];
    e->g[1] = pull[1] + guide * x[1];
    const double size = magnitude + d->gap + distance;
    e->size = sqrt(square(e->g[0]) + square(e->g[1]));
    e->noise = size * (DBL_EPSILON * (e->h[0] + e->h[2]) + 1e-6 * guide);
    e->loose = square(pull[0]) + square(pull[1]) >= square(0.03 * e->scale)
        && e->scale <= 100.0 * guide * size;
}

/* A step turned along the circle around the centre of the busiest groove. */
static void bent(const Evaluation *e, const double *step, double *out)
{
    int k = e->load[1] > e->load[0];
    int both = e->load[0] == e->load[1];
    double nz = e->nz[k], nr = e->nr[k], length = e->length[k];
    out[0] = step[0];
    out[1] = step[1];
    if (!(e->load[k] > 0) || (both ? e->mask[0] + e->mask[1] : e->mask[k]) == 0) return;
    if (both) {
        double w = 1.0 / (e->mask[0] + e->mask[1]);
        nz = w * (e->mask[0] * e->nz[0] + e->mask[1] * e->nz[1]);
        nr = w * (e->mask[0] * e->nr[0] + e->mask[1] * e->nr[1]);
        length = w * (e->mask[0] * e->length[0] + e->mask[1] * e->length[1]);
    }
    double along = nz * step[0] + nr * step[1];
    if (!(length + along > 0)) return;
    double z = length * nz + step[0], r = length * nr + step[1];
    double size = sqrt(fmax(z * z + r * r, DBL_MIN));
    double across2 = fmax(square(step[0]) + square(step[1]) - along * along, 0.0);
    double part = across2 / (size + length + along) / size;
    out[0] -= part * z;
    out[1] -= part * r;
}

/* Along the groove that carries most, no deeper into the other than needed. */
static void shape(
    const Design *d, const double *between, const double *x, const Evaluation *e,
    double *p)
{
    double turned[2], there[2], least = 1.0;
    Evaluation near;
    bent(e, p, turned);
    there[0] = x[0] + turned[0];
    there[1] = x[1] + turned[1];
    for (int k = 0; k < 2; k++) {
        if (!(e->approach[k] < 0)) continue;
        double wanted = cbrt(square(e->size / d->constant[k]));
        contact(d, k, between, there, &near);
        if (!(near.approach[k] > wanted)) continue;
        double slope = e->nz[k] * p[0] + e->nr[k] * p[1];
        double rise = wanted - e->approach[k];
        double curve = near.approach[k] - e->approach[k] - slope;
        double root = sqrt(fmax(slope * slope + 4.0 * curve * rise, 0.0));
        double share = 2.0 * rise / (slope + root);
        if (share > 0 && share < least) least = share;
    }
    if (least == 1.0) {
        memcpy(p, turned, sizeof turned);
        return;
    }
    double shorter[2] = {least * p[0], least * p[1]};
    bent(e, shorter, p);
}

static inline double form(const double *h, const double *p)
{
    return h[0] * p[0] * p[0] + 2.0 * h[1] * p[0] * p[1] + h[2] * p[1] * p[1];
}

/* Equilibrium of one ball from x = 0; returns the evaluations after the first. */
static int solve_ball(
    const Design *d, const double *between, double magnitude, double radius,
    Evaluation *state)
{
    Evaluation buffer, *now = state, *new = &buffer;
    double x[2] = {0, 0};
    int steps = 0, stalled = 0;
    evaluate(d, between, magnitude, x, now);
    while (!now->loose && now->size > TOLERANCE * now->scale + now->noise
           && steps < MAX_STEPS && !stalled) {
        double trace = now->h[0] + now->h[2];
        double shift = now->size / radius + DBL_EPSILON * trace / 2.0;
        double a = now->h[0] + shift, b = now->h[1], c = now->h[2] + shift;
        double inverse = 1.0 / (a * c - b * b);
        double p[2] = {
            -inverse * (c * now->g[0] - b * now->g[1]),
            -inverse * (a * now->g[1] - b * now->g[0])};
        double length = sqrt(p[0] * p[0] + p[1] * p[1]);
        if (length > radius) {
            p[0] *= radius / length;
            p[1] *= radius / length;
        }
        shape(d, between, x, now, p);
        length = sqrt(p[0] * p[0] + p[1] * p[1]);
        double there[2] = {x[0] + p[0], x[1] + p[1]};
        evaluate(d, between, magnitude, there, new);
        double slope = now->g[0] * p[0] + now->g[1] * p[1];
        double end = new->g[0] * p[0] + new->g[1] * p[1];
        double predicted = slope + 0.5 * form(now->h, p);
        double change = fmin(new->value - now->value, end);
        stalled = length <= 4.0 * DBL_EPSILON * sqrt(x[0] * x[0] + x[1] * x[1])
            && new->size > 0.5 * now->size;
        steps++;
        if (change <= 1e-4 * slope || new->size <= 0.5 * now->size) {
            if (change <= 0.7 * predicted || new->size <= 0.25 * now->size)
                radius = fmax(radius, 6.0 * length);
            Evaluation *old = now;
            now = new;
            new = old;
            memcpy(x, there, sizeof x);
        } else {
            double part = 1.0 - end / fmax(form(new->h, p), DBL_MIN);
            radius = length * fmin(fmax(part, 0.1), 0.9);
        }
    }
    if (now != state) *state = *now;
    return steps;
}

/* Force f (3) and stiffness k (3, 3) of a solved ball by inner - outer. */
static void condense(const Design *d, const Evaluation *e, double *f, double k[3][3])
{
    double side[3][2] = {{0}};
    memset(f, 0, 3 * sizeof *f);
    memset(k, 0, 9 * sizeof **k);
    for (int c = 0; c < 2; c++) {
        const double s = c ? -0.5 : 0.5, *h = e->k[c];
        const double lz = c ? d->lever[0] : 0.0, lr = c ? d->lever[1] : 0.0;
        const double fz = e->load[c] * e->nz[c], fr = e->load[c] * e->nr[c];
        const double tz = h[0] * lz + h[1] * lr, tr = h[1] * lz + h[2] * lr;
        f[0] += s * fz;
        f[1] += s * fr;
        f[2] += lz * fz + lr * fr;
        k[0][0] += 0.25 * h[0];
        k[0][1] += 0.25 * h[1];
        k[1][1] += 0.25 * h[2];
        k[0][2] += s * tz;
        k[1][2] += s * tr;
        k[2][2] += lz * tz + lr * tr;
        side[0][0] += s * h[0];
        side[0][1] += s * h[1];
        side[1][0] += s * h[1];
        side[1][1] += s * h[2];
        side[2][0] += tz;
        side[2][1] += tr;
    }
    const double a = e->h[0], b = e->h[1], c = e->h[2];
    const double inverse = 1.0 / (a * c - b * b);
    for (int i = 0; i < 3; i++) {
        double z = inverse * (c * side[i][0] - b * side[i][1]);
        double r = inverse * (a * side[i][1] - b * side[i][0]);
        for (int j = i; j < 3; j++) k[i][j] -= z * side[j][0] + r * side[j][1];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) k[i][j] = k[j][i];
}

/* Add a ball's share, first to the section (u, v, theta), then to the ring (6). */
static void add_share(
    const Design *d, double c, double s, const double *f, double k[3][3],
    double *force, double stiffness[6][6])
{
    const double r = d->pitch_radius;
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

/* Force (12) and stiffness (12, 12) at ring freedoms q (12), outer then inner ring.

`steps` gets the most evaluations that a ball took after its first. */
void force_stiffness(
    const Design *d, const double *q, double *force, double *stiffness, int *steps)
{
    double shift = 0, tilt = 0, y[6], sum[6] = {0}, block[6][6] = {{0}};
    for (int ring = 0; ring < 12; ring += 6) {
        for (int i = 0; i < 3; i++) shift = fmax(shift, fabs(q[ring + i]));
        for (int i = 3; i < 5; i++) tilt = fmax(tilt, fabs(q[ring + i]));
    }
    const double magnitude = shift + d->pitch_radius * tilt;
    const double pitch = 2.0 * acos(-1.0) / d->n_balls;
    const double first = d->first_azimuth
        + 0.5 * ((1.0 - d->ratio) * q[11] + (1.0 + d->ratio) * q[5]);
    const double lever = fmax(fabs(d->lever[0]), fabs(d->lever[1]));
    *steps = 0;
    for (int i = 0; i < 6; i++) y[i] = q[6 + i] - q[i];
    for (int l = 0; l < (int)d->n_balls; l++) {
        const double c = cos(first + l * pitch), s = sin(first + l * pitch);
        const double turn = c * y[4] - s * y[3];
        const double between[3] = {
            y[2] - d->pitch_radius * turn, c * y[0] + s * y[1], turn};
        const double radius = fabs(between[0]) + fabs(between[1])
            + lever * fabs(between[2]) + d->gap + 1e-6 * d->diameter;
        double f[3], k[3][3];
        Evaluation state;
        int taken = solve_ball(d, between, magnitude, radius, &state);
        *steps = taken > *steps ? taken : *steps;
        if (state.loose) continue;
        condense(d, &state, f, k);
        add_share(d, c, s, f, k, sum, block);
    }
    for (int i = 0; i < 6; i++) {
        force[i] = -sum[i];
        force[6 + i] = sum[i];
        for (int j = 0; j < 6; j++) {
            double value = j <= i ? block[i][j] : block[j][i];
            stiffness[12 * i + j] = stiffness[12 * (i + 6) + j + 6] = value;
            stiffness[12 * i + j + 6] = stiffness[12 * (i + 6) + j] = -value;
        }
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
