#pragma once

#include <skinglow/slab.h>

#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Orthonormal polynomials on the streams of one medium, the discrete counterpart of the Legendre
/// polynomials.
///
/// The phase function enters as sum over l of g^l q_l q_l^T. With sampled Legendre polynomials a rule that is
/// not exact to degree 4N leaks energy, and even when renormalized gives wrong anisotropy; these are
/// orthonormal on the rule itself, so that energy and mean cosine are kept to rounding, and since 2N of them
/// span everything on N + N streams, the forward peak (delta-M, Wiscombe 1977, J Atmos Sci 34:1408) is
/// contained and not cut off.
struct AngularBasis {
    Eigen::VectorXd cosine;
    Eigen::MatrixXd even;  ///< streams x N: column i is sqrt(w) q_(2i)
    Eigen::MatrixXd odd;   ///< streams x N: column i is sqrt(w) q_(2i+1)
    /// mu q_l = r_(l+1) q_(l+1) + r_l q_(l-1): entry l - 1 is r_l, l = 1 to 2N - 1.
    Eigen::VectorXd recurrence;
    double weight_sum = 1;  ///< of the rule before normalization; 1 but for its error

    /// @param cosine the rule's nodes on one hemisphere
    /// @param weight the rule's weights
    AngularBasis(Eigen::VectorXd cosine, const Eigen::VectorXd& weight);
};

/// The directions of a solve, shared by all layers.
///
/// A stream keeps n sin(theta) through the whole stack (Snell's law), so that a boundary between two indices
/// only splits each stream in two, exactly, and no energy is lost to interpolation. Streams are sorted by
/// that invariant: the first `count(n)` of them exist in a medium of index n, the rest are totally reflected
/// by it. Between two neighboring indices of the stack lies an interval with a Gauss rule of its own, in the
/// cosine of the interval's upper index: in that variable both the kink at the critical angle and the Fresnel
/// reflectance are smooth, and convergence is spectral.
///
/// Amplitudes: y = sqrt(W) I / n^2, with W = n^2 w mu the same in every medium. The flux of a stream is
/// sqrt(W) y (of a hemisphere of unit radiance: W), and all operators on y are symmetric by reciprocity.
class StreamGrid {
  public:
    /// Parameters and errors as for slab. Of the layers, the grid depends on the refractive indices alone: one
    /// grid serves all wavelengths of layers without dispersion. Normal and oblique beams are given a stream
    /// of their own.
    StreamGrid(std::span<const Layer> layers, Incidence incidence, double n_above, double n_below,
               int streams);

    /// Streams that propagate in a medium of this index.
    int count(double n) const;
    /// Cosine of a stream that propagates in a medium of index n.
    double cosine(int stream, double n) const;
    /// The cosines of all of them, and the phase function's basis on them; only for an index of a layer.
    const AngularBasis& basis(double n) const { return bases_.at(n); }

    /// Fresnel reflectance of unpolarized light at a boundary from index n_a to n_b; 1 where a stream does not
    /// propagate on both sides.
    double reflectance(int stream, double n_a, double n_b) const;

    double n_above() const { return n_above_; }
    double n_below() const { return n_below_; }
    int streams() const { return requested_; }
    int size() const { return static_cast<int>(streams_.size()); }
    double flux_weight(int stream) const { return streams_[static_cast<std::size_t>(stream)].flux_weight; }
    /// sqrt(W) of the first streams: its product with an amplitude is the flux.
    const Eigen::VectorXd& root_flux_weight() const { return root_flux_weight_; }

    /// Amplitudes above the first layer that carry the incident flux of 1. Diffuse light from an index above
    /// all the layers' is partly left out: what is totally reflected at once, `reflected_outright`.
    const Eigen::VectorXd& incident() const { return incident_; }
    double reflected_outright() const { return reflected_outright_; }

  private:
    struct Stream {
        double interval_index;  // refractive index at the upper end of its interval
        double cosine;          // in that index
        double flux_weight;
    };
    void add_interval(double n_low, double n_high, int count, bool beam_here, double beam_cosine);

    std::vector<Stream> streams_;
    Eigen::VectorXd root_flux_weight_;
    Eigen::VectorXd incident_;
    double reflected_outright_ = 0;
    std::map<double, AngularBasis> bases_;
    double n_above_, n_below_;
    int requested_;
};

/// Throws std::invalid_argument that names the layer, the field, its value and what is allowed.
void check_arguments(std::span<const Layer> layers, Incidence incidence, double n_above, double n_below,
                     int streams);

/// A fraction of the incident flux with its rounding errors below 0 and above 1 taken away. Where it is
/// outside by more, the streams are too few for the phase function: throws std::invalid_argument.
/// @param name of the fraction, for the message
double flux_fraction(const char* name, double value, int streams);

}  // namespace skinglow::detail
