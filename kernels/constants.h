// SPDX-License-Identifier: MIT
// Constants of formulas that kernels and the reference (src/) each write down for themselves. No types: both languages
// read this file.
#ifndef APSLK_CONSTANTS_H
#define APSLK_CONSTANTS_H

// Numbers a vertex in Buffers::contacts.
#define APSLK_CONTACT_SIZE 8

// A greatest area change up to which a cloth is at rest: 32-bit positions tell no better.
#define APSLK_AT_REST 1e-5f

// Bending and tethers act in small steps, not in the step without a limit: what falls or flies has no area change
// there. Area changes and excesses of stretch up to this are not worse than those of that step.
#define APSLK_LET_PASS_IN_PARTS 0.01f

// The area that a small step asks of a triangle at most, as a multiple of its present area. A linearised step from
// nearly no area overshoots without bound.
#define APSLK_GREATEST_GROWTH 4.0f

// The least effective mass of a vertex, in stiffnesses of the tension around it. Explicit steps swing from ½ down, with
// growing amplitude (docs/formulation.md, Effective masses).
#define APSLK_MASS_PER_STIFFNESS 2.0f
// What is left of a stiffness one sub-step later: a swing passes through zero tension.
#define APSLK_STIFFNESS_KEPT 0.9f
// The greatest effective mass, in geometric mean masses of the cloth. A heavier vertex needs more pressure, which
// stiffens it.
#define APSLK_GREATEST_MEAN_MASSES 10.0f

// Stretch ceiling (docs/formulation.md, Stretch ceiling).
#define APSLK_LEAST_STRETCH_CEILING 1.01f
// A row takes part from this far below its ceiling on: areas that are corrected may push it over.
#define APSLK_STRETCH_MARGIN 0.05f
// The share of an excess that one sub-step takes; the next takes up what it leaves.
#define APSLK_EXCESS_TAKEN 0.6f
// Of |∇C|²: what a row demands beyond its triangle's area row is noise below.
#define APSLK_LEAST_ROW_SHARE 1e-6f
// Of |∇C|² too: a row is weak below, and asked for less than it demands.
#define APSLK_WEAK_ROW_SHARE 0.1f
// An area row is weak where Σ |∇A|² of the corners that can move is below this share of A⁰ and one corner cannot.
#define APSLK_WEAK_AREA_ROW_SHARE 0.1f
// Sub-steps that follow the need (Parameters::most_sub_steps). The excess that a whole step may make for each of them,
#define APSLK_EXCESS_A_SUB_STEP 0.23f
// the ratio of the greatest effective mass to the one given that they aim at: K h²/m grows with it,
#define APSLK_AIMED_MASS_RATIO 8.0f
// and what a call keeps of the number that the one before asked for.
#define APSLK_ASKED_KEPT 0.8f
// Area errors of the start of the step are led back over the first of this number of parts of it.
#define APSLK_PARTS_OF_LEAD 3
// An excess of the start is held in ever smaller part, less by exp(−this / small steps) from one to the next.
#define APSLK_EXCESS_LEAD 7.0f
// What a sub-step was asked to take of an excess and could not is asked of the next no faster than this a step: pins
// that leave no room below a ceiling have it give way, where tension would grow without bound.
#define APSLK_EXCESS_ASKED_AGAIN 0.45f
// Up to twice as fast where the calls before had little tension: the square of the sub-steps that it asked for, over
// those that are taken, is below this.
#define APSLK_LITTLE_TENSION 0.4f
// Where areas are better than before, an excess of stretch may be greater by this factor: pins may leave no room.
#define APSLK_GROWTH_LET_PASS 1.5f
// Added mass of a vertex, in stiffnesses of the tension around it.
#define APSLK_MASS_ADDED_PER_STIFFNESS 4.0f
// What such a vertex weighs at most, in masses as given: what pins leave no place would weigh ever more, and let go
// with all of it.
#define APSLK_GREATEST_MASS_RATIO 1000.0f
// The bound is that of the very triangles and masses that are solved with: this is for rounding.
#define APSLK_ROWS_BOUND_MARGIN 1.02f
// Both rows' bound is that much larger than that of areas alone (APSLK_CHEBYSHEV_REACH), and their polynomial longer.
#define APSLK_ROWS_REACH 7.2f

// Bending (docs/formulation.md, Bending). The greatest that a polynomial makes of h² W K: explicit steps swing without
// limit from 4/(1 + 2 lead) on.
#define APSLK_BENDING_GREATEST 2.4f
// T_d at zero of the polynomial: how far its values stay above zero, which damps what is stiffest.
#define APSLK_BENDING_RIPPLE 1.1f
// Bends are those of positions this far on in the part, by the velocities of its start: a damping.
#define APSLK_BENDING_LEAD 0.25f

// Energy of a whole step, against what is allowed (docs/formulation.md, Energy). What is let pass: the discrete step is
// a little off, and a cloth that is near its limits corrects itself.
#define APSLK_ENERGY_LET_PASS 1.002f
#define APSLK_ENERGY_LET_PASS_WITHIN 0.2f
// An area change, or a stretch over the ceiling, from which on no more than the first of them passes.
#define APSLK_UNMET 0.05f
// What a body that is faster than a vertex sets in motion by it, in masses of the vertex.
#define APSLK_PULLED_ALONG 16.0f

// Safety factor of the bound of the matrix. With Options::bound_interval above 1 the directions in it are those of an
// earlier sub-step, and the cloth has moved since.
#define APSLK_BOUND_MARGIN 1.1f
// Further safety factor at vertices whose masses are raised: slivers turn fast.
#define APSLK_RAISED_MARGIN 1.2f
// A Chebyshev polynomial of degree √(this / (α − 1)) reaches as far as α (src/chebyshev_products.hpp).
#define APSLK_CHEBYSHEV_REACH 2.8f

// The α − 1 that an adaptive factor multiplies at least, so that α = 1 is raised too, and the greatest such factor.
#define APSLK_LEAST_ADAPTED_DAMPING 0.05f
#define APSLK_GREATEST_ADAPTIVE_FACTOR 1024.0f

#endif
