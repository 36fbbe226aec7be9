#include "study/accuracy/finite_elements.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "nsma/orbit/backbone.hpp"
#include "nsma/orbit/orbit.hpp"

namespace {

using nsma::FiniteElementBar;
using nsma::FiniteElementOptions;
using nsma::FiniteElementScheme;

constexpr FiniteElementScheme schemes[] = {FiniteElementScheme::central_penalty, FiniteElementScheme::moreau_jean};

nsma::Bar far_wall() { return {2.0, 8.0, 0.5, 0.25, 1e6}; }

// The first linear mode, by cells: strain cos(pi s/2L), at rest.
nsma::State first_mode(const nsma::Bar& bar, int cells) {
    nsma::State state = nsma::State::Zero(2 * cells);
    for (int i = 0; i < cells; ++i) {
        const double a = M_PI_2 * i / cells;
        const double b = M_PI_2 * (i + 1) / cells;
        state[i] = bar.young_modulus * (std::sin(b) - std::sin(a)) * cells / bar.length;  // u = sin at the nodes
    }
    return state;
}

// Tip after a quarter of the exact period, where the exact one is zero.
double quarter_error(FiniteElementScheme scheme, int elements, double courant) {
    const nsma::Bar bar = far_wall();
    FiniteElementOptions options;
    options.scheme = scheme;
    options.elements = elements;
    options.courant = courant;
    FiniteElementBar march(bar, {elements}, first_mode(bar, elements), bar.travel_time(), options);
    for (int n = 0; n < march.steps(); ++n) march.step();
    return std::abs(march.tip());
}

TEST(FiniteElements, FreeVibrationConvergesWithOrderTwo) {
    for (const auto scheme : schemes) {
        const double coarse = quarter_error(scheme, 16, 0.5);
        const double fine = quarter_error(scheme, 64, 0.5);
        EXPECT_GT(coarse, 1e-6);
        EXPECT_NEAR(std::log(coarse / fine) / std::log(4.0), 2.0, 0.1);  // asymptotic by 16 elements
    }
}

TEST(FiniteElements, CentralDifferencesAtTheStableLimitAreExactInFreeMotion) {
    EXPECT_LE(quarter_error(FiniteElementScheme::central_penalty, 16, 1.0), 1e-12);  // d'Alembert at the nodes
}

TEST(FiniteElements, FreeMotionKeepsEnergy) {
    const nsma::Bar bar = far_wall();
    for (const auto scheme : schemes) {
        FiniteElementOptions options;
        options.scheme = scheme;
        options.elements = 32;
        options.courant = 0.5;
        FiniteElementBar march(bar, {32}, first_mode(bar, 32), 4 * bar.travel_time(), options);
        const double energy = march.energy();
        for (int n = 0; n < 10 * march.steps(); ++n) march.step();
        // The trapezoidal rule keeps it; central differences keep a nearby quadratic form.
        EXPECT_NEAR(march.energy(), energy, (scheme == FiniteElementScheme::moreau_jean ? 1e-12 : 1e-3) * energy);
        EXPECT_FALSE(march.in_contact());
    }
}

TEST(FiniteElements, StartKeepsEnergyOfNodalDisplacementsAndMomentum) {
    const nsma::Bar bar = far_wall();
    const int cells = 6;
    nsma::State state = nsma::State::Zero(2 * cells);
    for (int i = 0; i < cells; ++i) {
        state[i] = 1.0 + i;
        state[cells + i] = 2.0 - i;
    }
    const FiniteElementBar march(bar, {cells}, state, 1.0, {.elements = cells});
    EXPECT_NEAR(march.tip(), nsma::tip_displacement(bar, {cells}, state), 1e-14 * 21);
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(cells);
    nsma::State strained = state;
    strained.tail(cells).setZero();
    EXPECT_NEAR(march.energy_of(march.displacement(), still), nsma::energy(bar, {cells}, strained), 1e-12);
    // A uniform velocity is kept everywhere.
    state.tail(cells).setConstant(3.0);
    const FiniteElementBar uniform(bar, {cells}, state, 1.0, {.elements = 4});
    EXPECT_LE((uniform.velocity().array() - 3.0).abs().maxCoeff(), 1e-13);
}

// Flies at the wall with one speed, at rest otherwise: contact lasts one round trip, 2 L/c.
int contact_steps(const FiniteElementOptions& options, double& energy_left, int& steps) {
    nsma::Bar bar;
    bar.gap = 0.05;
    const int cells = 50;
    nsma::State state = nsma::State::Zero(2 * cells);
    state.tail(cells).setConstant(0.1);
    FiniteElementBar march(bar, {cells}, state, 1.0, options);
    const double energy = march.energy();
    int seen = 0;
    for (int n = 0; n < 2 * march.steps(); ++n) {
        march.step();
        if (march.in_contact()) ++seen;
    }
    steps = march.steps();
    energy_left = march.energy() / energy;
    return seen;
}

TEST(FiniteElements, TheWallStopsTheTipAndReleasesIt) {
    for (const auto scheme : schemes) {
        FiniteElementOptions options;
        options.scheme = scheme;
        options.elements = 100;
        options.courant = 0.5;
        double energy = 0;
        int steps = 0;
        EXPECT_GT(contact_steps(options, energy, steps), 0);
        EXPECT_LE(energy, 1 + 1e-2);  // central differences keep a nearby energy only
        EXPECT_GE(energy, 0.8);       // an impact takes the energy of one node at most
    }
}

TEST(FiniteElements, ImpactWithoutRestitutionNeverGainsEnergy) {
    FiniteElementOptions options;
    options.elements = 40;
    nsma::Bar bar;
    bar.gap = 0.01;
    nsma::State state = nsma::State::Zero(80);
    state.tail(40).setConstant(0.1);
    FiniteElementBar march(bar, {40}, state, 1.0, options);
    double before = march.energy();
    for (int n = 0; n < 400; ++n) {
        march.step();
        EXPECT_LE(march.energy(), before * (1 + 1e-12));  // rounding
        before = march.energy();
    }
}

TEST(FiniteElements, RefusesAStateOfAnotherMesh) {
    EXPECT_THROW(FiniteElementBar({}, {3}, nsma::State::Zero(4), 1.0, {}), std::invalid_argument);
}

}  // namespace
