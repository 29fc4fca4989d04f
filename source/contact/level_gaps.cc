// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/level_gaps.h>

namespace retroforge
{
  namespace
  {
    /// Constant weight beside those of the edges that touch: an offset sets in smoothly where a first edge
    /// touches.
    constexpr double first_touch = 0.25;

    /// c_m, by the polynomial of the friction ramp.
    const FrictionRamp smoothness{sharp_bulge - smooth_bulge, false};

    /// The bulge of the die under an edge, from its middle and ends.
    template <typename Number>
    struct Bulge
    {
      Number b;      ///< [mm]
      Number length; ///< of the edge [mm]
      Number c;
      Number w; ///< of the middle's own gap

      /// |b|/length beyond a smooth die's
      double excess() const { return std::abs(value_of(b)) / value_of(length) - smooth_bulge; }
    };

    template <typename Number>
    Bulge<Number> bulge_of(const Chord                &chord,
                           const NodalVectors<Number> &X,
                           const FrictionRamp         &ramp,
                           const ContactSet<Number>   &contact)
    {
      using std::sqrt;
      const ContactPair    &pair = contact.pairs[chord.middle];
      const Vector3<Number> edge = X[pair.point.nodes[0]] - X[pair.point.nodes[1]];
      const auto           &gaps = contact.own_gaps;
      Bulge<Number>         bulge;
      bulge.b           = 0.5 * (gaps[chord.ends[0]] + gaps[chord.ends[1]]) - gaps[chord.middle];
      bulge.length      = sqrt(Number(edge * edge));
      const Number size = value_of(bulge.b) < 0. ? Number(-bulge.b) : bulge.b;
      bulge.c           = smoothness(Number(size / bulge.length - smooth_bulge), true);
      bulge.w           = own_ramp(contact, ramp, chord.middle, gaps[chord.middle]);
      return bulge;
    }

    /// Numerator and denominator of o_v of each pair; of middles zero and one.
    template <typename Number>
    struct Offsets
    {
      std::vector<Number> bulges, weights;

      Offsets(const std::vector<Bulge<Number>> &bulge, const ContactSet<Number> &contact)
          : bulges(contact.pairs.size(), Number(0.)), weights(contact.pairs.size(), Number(first_touch))
      {
        for (std::size_t e = 0; e < bulge.size(); ++e)
          for (unsigned int i = 0; i < 2; ++i)
          {
            const unsigned int v = contact.chords[e].ends[i];
            const Number       w = double(contact.chords[e].images[i]) * bulge[e].w;
            bulges[v] += w * bulge[e].c * bulge[e].b;
            weights[v] += w;
          }
      }
    };

    template <typename Number>
    std::vector<Bulge<Number>>
    bulges_of(const NodalVectors<Number> &X, const FrictionRamp &ramp, const ContactSet<Number> &contact)
    {
      std::vector<Bulge<Number>> bulges;
      for (const Chord &chord : contact.chords)
        bulges.push_back(bulge_of(chord, X, ramp, contact));
      return bulges;
    }
  } // namespace

  EdgeFit edge_fit(const NodalVectors<double> &X, const FrictionRamp &ramp, const ContactSet<double> &contact)
  {
    constexpr double half   = 0.5;
    const auto       bulges = bulges_of(X, ramp, contact);
    EdgeFit          fit;
    for (std::size_t e = 0; e < bulges.size(); ++e)
    {
      const Chord &chord   = contact.chords[e];
      const auto   touches = [&](const unsigned int p) {
        return own_ramp(contact, ramp, p, contact.own_gaps[p]) >= half;
      };
      if (!touches(chord.middle) && !(touches(chord.ends[0]) && touches(chord.ends[1])))
        continue;
      ++fit.touching;
      const double relative = std::abs(bulges[e].b) / bulges[e].length;
      if (relative >= sharp_bulge)
        ++fit.spanning;
      if (relative <= fit.largest)
        continue;
      const ContactPair &pair = contact.pairs[chord.middle];
      fit.largest             = relative;
      fit.die                 = pair.die;
      fit.place               = 0.5 * (X[pair.point.nodes[0]] + X[pair.point.nodes[1]]);
    }
    return fit;
  }

  template <typename Number>
  void level_gaps(const NodalVectors<Number> &X, const FrictionRamp &ramp, ContactSet<Number> &contact)
  {
    contact.own_gaps.clear();
    for (const auto &projection : contact.projections)
      contact.own_gaps.push_back(projection.delta);
    const auto            bulges = bulges_of(X, ramp, contact);
    const Offsets<Number> offsets(bulges, contact);
    const auto            set = [&](const unsigned int p, const Number &gap) {
      contact.projections[p].delta = gap;
      contact.ramps[p]             = own_ramp(contact, ramp, p, gap);
    };
    for (const Chord &chord : contact.chords)
      for (const unsigned int v : chord.ends)
        set(v, contact.own_gaps[v] - offsets.bulges[v] / offsets.weights[v]);
    for (std::size_t e = 0; e < contact.chords.size(); ++e)
    {
      const auto &[m, ends, images] = contact.chords[e];
      if (value_of(bulges[e].c) < 1.)
        for (const unsigned int v : ends)
          contact.middles_around[v].clear();
      const Number wanted = 0.5 * (contact.projections[ends[0]].delta + contact.projections[ends[1]].delta);
      const Number part   = contact.ramps[ends[0]] * contact.ramps[ends[1]] * bulges[e].c;
      set(m, contact.own_gaps[m] + part * (wanted - contact.own_gaps[m]));
    }
  }

  template void level_gaps(const NodalVectors<double> &, const FrictionRamp &, ContactSet<double> &);
  template void level_gaps(const NodalVectors<Dual> &, const FrictionRamp &, ContactSet<Dual> &);

  void reverse_level_gaps(const NodalVectors<double> &X,
                          const FrictionRamp         &ramp,
                          const ContactSet<double>   &contact,
                          const std::vector<double>  &ramps_bar,
                          std::vector<double>        &gaps_bar,
                          std::vector<double>        &scales_bar,
                          NodalVectors<double>       &X_bar)
  {
    AssertDimension(ramps_bar.size(), contact.pairs.size());
    AssertDimension(gaps_bar.size(), contact.pairs.size());
    AssertDimension(scales_bar.size(), contact.pairs.size());
    AssertDimension(X_bar.size(), X.size());
    const auto            bulges = bulges_of(X, ramp, contact);
    const Offsets<double> offsets(bulges, contact);
    const auto            gap = [&](const unsigned int p) { return contact.projections[p].delta; };
    const auto reverse_ramp   = [&](const unsigned int p, const double at, const double of, double &at_bar) {
      reverse_own_ramp(contact, ramp, p, at, of, at_bar, scales_bar[p]);
    };
    std::vector<double> w_bar = ramps_bar, c_bar(bulges.size(), 0.);
    // The middles' gaps, which depend on their ends'.
    for (std::size_t e = 0; e < bulges.size(); ++e)
    {
      const auto &[m, ends, images] = contact.chords[e];
      double at_middle              = gaps_bar[m];
      reverse_ramp(m, gap(m), w_bar[m], at_middle);
      const double apart = 0.5 * (gap(ends[0]) + gap(ends[1])) - contact.own_gaps[m];
      const double both  = contact.ramps[ends[0]] * contact.ramps[ends[1]];
      w_bar[m]           = 0.;
      gaps_bar[m]        = (1. - both * bulges[e].c) * at_middle;
      c_bar[e]           = both * apart * at_middle;
      for (unsigned int i = 0; i < 2; ++i)
      {
        gaps_bar[ends[i]] += 0.5 * both * bulges[e].c * at_middle;
        w_bar[ends[i]] += contact.ramps[ends[1 - i]] * bulges[e].c * apart * at_middle;
      }
    }
    // The ramps of all others, which depend on nothing but their gaps, and the vertices' offsets.
    for (unsigned int p = 0; p < gaps_bar.size(); ++p)
      reverse_ramp(p, gap(p), w_bar[p], gaps_bar[p]);
    const std::vector<double> levelled_bar = gaps_bar;
    for (std::size_t e = 0; e < bulges.size(); ++e)
    {
      const auto &[m, ends, images] = contact.chords[e];
      const auto &bulge             = bulges[e];
      double      b_bar = 0., own_w_bar = 0.;
      for (unsigned int i = 0; i < 2; ++i)
      {
        const unsigned int v         = ends[i];
        const double       sum_bar   = -(images[i] * levelled_bar[v]) / offsets.weights[v];
        const double       share_bar = -sum_bar * offsets.bulges[v] / offsets.weights[v];
        b_bar += sum_bar * bulge.w * bulge.c;
        c_bar[e] += sum_bar * bulge.w * bulge.b;
        own_w_bar += sum_bar * bulge.c * bulge.b + share_bar;
      }
      const double size_bar = c_bar[e] * smoothness.derivative(bulge.excess()) / bulge.length;
      b_bar += bulge.b < 0. ? -size_bar : size_bar;
      reverse_ramp(m, contact.own_gaps[m], own_w_bar, gaps_bar[m]);
      gaps_bar[m] -= b_bar;
      for (const unsigned int v : ends)
        gaps_bar[v] += 0.5 * b_bar;
      const auto &nodes = contact.pairs[m].point.nodes;
      const Vec3  along =
        -size_bar * std::abs(bulge.b) / (bulge.length * bulge.length) * (X[nodes[0]] - X[nodes[1]]);
      X_bar[nodes[0]] += along;
      X_bar[nodes[1]] -= along;
    }
  }
} // namespace retroforge
