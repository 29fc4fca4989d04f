// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/config.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/reference_cell.h>

#include <retroforge/element/cell_geometry.h>
#include <retroforge/output/field_file.h>
#include <retroforge/output/safe_file.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    constexpr const char *vtk_type = nullptr;
    template <>
    constexpr const char *vtk_type<float> = "Float32";
    template <>
    constexpr const char *vtk_type<std::int32_t> = "Int32";
    template <>
    constexpr const char *vtk_type<std::uint8_t> = "UInt8";

#ifdef DEAL_II_WORDS_BIGENDIAN
    constexpr const char *byte_order = "BigEndian";
#else
    constexpr const char *byte_order = "LittleEndian";
#endif

    /// As VTK has binary data within XML: the number of bytes, then these.
    template <typename Number>
    std::string encoded(const std::vector<Number> &values)
    {
      const std::uint32_t        n_bytes = values.size() * sizeof(Number);
      std::vector<unsigned char> bytes(sizeof(n_bytes) + n_bytes);
      std::memcpy(bytes.data(), &n_bytes, sizeof(n_bytes));
      std::memcpy(bytes.data() + sizeof(n_bytes), values.data(), n_bytes);
      return dealii::Utilities::encode_base64(bytes);
    }

    template <typename Number>
    void write_array(std::ostream              &out,
                     const std::string         &name,
                     const unsigned int         n_components,
                     const std::vector<Number> &values)
    {
      out << "<DataArray type=\"" << vtk_type<Number> << "\" Name=\"" << name << "\" NumberOfComponents=\""
          << n_components << "\" format=\"binary\">" << encoded(values) << "</DataArray>\n";
    }
  } // namespace

  template <int dim>
  FieldFile<dim>::FieldFile(const NodalVectors<double>                        &X,
                            const std::vector<std::array<NodeIndex, dim + 1>> &cells)
      : n_nodes_(X.size()), n_cells_(cells.size()), n_points_per_cell_(dim + 1)
  {
    add_linear("", "", X);
    X_ = std::move(point_data_.back());
    point_data_.pop_back();
    connectivity_.reserve(n_cells_ * n_points_per_cell_);
    for (const auto &cell : cells)
      connectivity_.insert(connectivity_.end(), cell.begin(), cell.end());
  }

  template <int dim>
  template <typename ValueAt>
  void FieldFile<dim>::add(std::vector<Array> &data,
                           const std::string  &name,
                           const std::string  &unit,
                           const std::size_t   n,
                           const unsigned int  n_components,
                           const ValueAt      &value_at)
  {
    Array array{unit.empty() ? name : name + " [" + unit + "]", n_components, {}};
    array.values.reserve(n * n_components);
    for (std::size_t i = 0; i < n; ++i)
      for (unsigned int component = 0; component < n_components; ++component)
        array.values.push_back(static_cast<float>(value_at(i, component)));
    data.push_back(std::move(array));
  }

  template <int dim>
  void FieldFile<dim>::add_linear(const std::string         &name,
                                  const std::string         &unit,
                                  const std::vector<double> &values)
  {
    AssertDimension(values.size(), n_nodes_);
    add(point_data_, name, unit, n_nodes_, 1, [&](const std::size_t k, unsigned int) { return values[k]; });
  }

  template <int dim>
  void FieldFile<dim>::add_linear(const std::string          &name,
                                  const std::string          &unit,
                                  const NodalVectors<double> &values)
  {
    AssertDimension(values.size(), n_nodes_);
    add(point_data_, name, unit, n_nodes_, 3, [&](const std::size_t k, const unsigned int component) {
      return values[k][component];
    });
  }

  template <int dim>
  void FieldFile<dim>::add_velocity(const std::string          &name,
                                    const std::string          &unit,
                                    const NodalVectors<double> &values,
                                    const MiddleNodes          *middles)
  {
    if (middles)
      make_quadratic(*middles);
    AssertDimension(values.size(), n_nodes_ + edges_.size());
    add(point_data_, name, unit, values.size(), 3, [&](const std::size_t k, const unsigned int component) {
      return values[k][component];
    });
  }

  template <int dim>
  void FieldFile<dim>::make_quadratic(const MiddleNodes &middles)
  {
    // A triangle's edges are the first three of a tetrahedron's.
    constexpr unsigned int          n_edges = dim * (dim + 1) / 2;
    const std::vector<std::int32_t> corners = std::move(connectivity_);
    edges_                                  = middles.ends();
    n_points_per_cell_                      = dim + 1 + n_edges;
    connectivity_.clear();
    for (auto cell = corners.begin(); cell != corners.end(); cell += dim + 1)
    {
      connectivity_.insert(connectivity_.end(), cell, cell + dim + 1);
      for (unsigned int e = 0; e < n_edges; ++e) // in VTK's order, too
        connectivity_.push_back(middles.between(cell[tet_edge_corners[e][0]], cell[tet_edge_corners[e][1]]));
    }
  }

  template <int dim>
  void FieldFile<dim>::add_constant(const std::string         &name,
                                    const std::string         &unit,
                                    const std::vector<double> &values)
  {
    AssertDimension(values.size(), n_cells_);
    add(cell_data_, name, unit, n_cells_, 1, [&](const std::size_t c, unsigned int) { return values[c]; });
  }

  template <int dim>
  void FieldFile<dim>::add_constant(const std::string                  &name,
                                    const std::string                  &unit,
                                    const std::vector<SymmetricTensor> &values)
  {
    AssertDimension(values.size(), n_cells_);
    // of SymmetricTensor: xx, yy, zz, yz, xz, xy
    constexpr unsigned int entry[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2};
    add(cell_data_, name, unit, n_cells_, 9, [&](const std::size_t c, const unsigned int component) {
      return values[c][entry[component]];
    });
  }

  template <int dim>
  void FieldFile<dim>::add_symmetry_planes(const std::vector<Plane> &planes)
  {
    if (planes.empty())
      return;
    std::ostringstream out;
    out.precision(std::numeric_limits<double>::max_digits10);
    out << R"(<FieldData>
<DataArray type="Float64" Name="symmetry_planes" NumberOfComponents="6" NumberOfTuples=")"
        << planes.size() << R"(" format="ascii">)";
    for (const Plane &plane : planes)
      out << ' ' << plane.point << ' ' << plane.normal;
    out << "</DataArray>\n</FieldData>\n";
    planes_ = out.str();
  }

  template <int dim>
  void FieldFile<dim>::write_at_points(std::ostream &out, const Array &array) const
  {
    const unsigned int n      = array.n_components;
    std::vector<float> values = array.values;
    if (values.size() == n_nodes_ * n)
      for (const auto &[a, b] : edges_)
        for (unsigned int component = 0; component < n; ++component)
          values.push_back(0.5F * (values[a * n + component] + values[b * n + component]));
    write_array(out, array.name, n, values);
  }

  template <int dim>
  void FieldFile<dim>::write_cells(std::ostream &out) const
  {
    std::vector<std::int32_t> ends(n_cells_);
    for (std::size_t c = 0; c < n_cells_; ++c)
      ends[c] = (c + 1) * n_points_per_cell_;
    const auto         cell = dealii::ReferenceCells::get_simplex<dim>();
    const std::uint8_t type = edges_.empty() ? cell.vtk_linear_type() : cell.vtk_quadratic_type();
    out << "<Cells>\n";
    write_array(out, "connectivity", 1, connectivity_);
    write_array(out, "offsets", 1, ends);
    write_array(out, "types", 1, std::vector<std::uint8_t>(n_cells_, type));
    out << "</Cells>\n";
  }

  template <int dim>
  void FieldFile<dim>::write(const std::string &file) const
  {
    std::ostringstream out;
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\""
        << byte_order << "\">\n<UnstructuredGrid>\n"
        << planes_ << "<Piece NumberOfPoints=\"" << n_nodes_ + edges_.size() << "\" NumberOfCells=\""
        << n_cells_ << "\">\n<Points>\n";
    write_at_points(out, X_);
    out << "</Points>\n";
    write_cells(out);
    out << "<PointData>\n";
    for (const Array &array : point_data_)
      write_at_points(out, array);
    out << "</PointData>\n<CellData>\n";
    for (const Array &array : cell_data_)
      write_array(out, array.name, array.n_components, array.values);
    out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    write_file(file, out.str());
  }

  template class FieldFile<2>;
  template class FieldFile<3>;
} // namespace retroforge
