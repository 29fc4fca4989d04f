// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/whole_part.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/output/vtu_writer.h>
#include <retroforge/output/xml.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/utilities.h>

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <type_traits>

namespace retroforge
{
  namespace
  {
    constexpr std::size_t  block_size   = 1 << 18; // bytes compressed at a time
    constexpr std::uint8_t vtk_triangle = 5, vtk_tetrahedron = 10;

    template <typename T>
    std::string vtk_type()
    {
      const std::string kind = std::is_floating_point_v<T> ? "Float" : std::is_signed_v<T> ? "Int" : "UInt";
      return kind + std::to_string(8 * sizeof(T));
    }

    std::string base64(const void *data, const std::size_t n_bytes)
    {
      const auto *bytes = static_cast<const unsigned char *>(data);
      return dealii::Utilities::encode_base64(std::vector<unsigned char>(bytes, bytes + n_bytes));
    }

    /// VTK's compressed array: base64 of the header {number of blocks, size of a block, size of the last
    /// block if it is shorter, compressed size of each block}, followed by base64 of the compressed blocks.
    std::string compressed(const unsigned char *bytes, const std::size_t n_bytes)
    {
      const std::size_t n_blocks = (n_bytes + block_size - 1) / block_size;

      std::vector<std::uint32_t> header = {static_cast<std::uint32_t>(n_blocks),
                                           static_cast<std::uint32_t>(block_size),
                                           static_cast<std::uint32_t>(n_bytes % block_size)};
      std::vector<unsigned char> blocks, block(compressBound(block_size));
      for (std::size_t begin = 0; begin < n_bytes; begin += block_size)
      {
        uLongf    size  = block.size();
        const int error = compress2(
          block.data(), &size, bytes + begin, std::min(block_size, n_bytes - begin), Z_DEFAULT_COMPRESSION);
        AssertThrow(error == Z_OK, dealii::ExcMessage("zlib failed to compress"));
        header.push_back(size);
        blocks.insert(blocks.end(), block.begin(), block.begin() + size);
      }
      return base64(header.data(), header.size() * sizeof(std::uint32_t)) +
             base64(blocks.data(), blocks.size());
    }

    template <typename T>
    std::string
    data_array(const std::string &name, const unsigned int n_components, const std::vector<T> &values)
    {
      return "<DataArray type=\"" + vtk_type<T>() + "\" Name=\"" + xml_escaped(name) +
             "\" NumberOfComponents=\"" + std::to_string(n_components) + "\" NumberOfTuples=\"" +
             std::to_string(values.size() / n_components) + "\" format=\"binary\">\n" +
             compressed(reinterpret_cast<const unsigned char *>(values.data()), values.size() * sizeof(T)) +
             "\n</DataArray>\n";
    }

    template <typename T>
    std::vector<T> components(const NodalVectors<double> &vectors)
    {
      std::vector<T> values;
      values.reserve(3 * vectors.size());
      for (const Vec3 &v : vectors)
        for (unsigned int d = 0; d < 3; ++d)
          values.push_back(static_cast<T>(v[d]));
      return values;
    }

    std::vector<float> components(const ScalarField &field)
    {
      return {field.values.begin(), field.values.end()};
    }

    std::vector<float> components(const VectorField &field)
    {
      return components<float>(field.values);
    }

    std::vector<float> components(const TensorField &field)
    {
      std::vector<float> values;
      for (const SymmetricTensor &s : field.values)
        for (const unsigned int k : {0, 1, 2, 5, 3, 4}) // yz, xz, xy -> xy, yz, xz
          values.push_back(static_cast<float>(s[k]));
      return values;
    }

    template <typename Field>
    std::string
    arrays(const std::vector<Field> &fields, const unsigned int n_components, const std::size_t n_values)
    {
      std::string text;
      for (const Field &field : fields)
      {
        AssertThrow(field.values.size() == n_values,
                    dealii::ExcDimensionMismatch(field.values.size(), n_values));
        text += data_array(field.name, n_components, components(field));
      }
      return text;
    }

    /// Point and outward normal of each plane, as field data; nothing where there is none.
    std::string symmetry(const TetMesh &mesh)
    {
      std::vector<double> numbers;
      for (const Plane &plane : symmetry_planes(mesh))
        for (const Vec3 &vector : {plane.point, plane.normal})
          numbers.insert(numbers.end(), vector.begin_raw(), vector.end_raw());
      return numbers.empty() ? ""
                             : "<FieldData>\n" + data_array("symmetry_planes", 6, numbers) + "</FieldData>\n";
    }

    template <std::size_t n_corners>
    std::string cell_arrays(const std::vector<std::array<unsigned int, n_corners>> &cells)
    {
      constexpr std::uint8_t    type = n_corners == 3 ? vtk_triangle : vtk_tetrahedron;
      std::vector<std::int32_t> connectivity, offsets;
      for (const auto &cell : cells)
      {
        connectivity.insert(connectivity.end(), cell.begin(), cell.end());
        offsets.push_back(connectivity.size());
      }
      return data_array("connectivity", 1, connectivity) + data_array("offsets", 1, offsets) +
             data_array("types", 1, std::vector<std::uint8_t>(cells.size(), type));
    }

    std::string byte_order()
    {
      const std::uint16_t one = 1;
      return *reinterpret_cast<const unsigned char *>(&one) == 1 ? "LittleEndian" : "BigEndian";
    }
    template <std::size_t n_corners>
    void write_grid(const std::string                                      &file,
                    const std::vector<std::array<unsigned int, n_corners>> &cells,
                    const NodalVectors<double>                             &X,
                    const std::string                                      &point_arrays,
                    const std::string                                      &cell_fields = "",
                    const std::string                                      &field_data  = "")
    {
      write_file(file,
                 "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"" +
                   byte_order() + "\" header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\">\n" +
                   "<UnstructuredGrid>\n" + field_data + "<Piece NumberOfPoints=\"" +
                   std::to_string(X.size()) + "\" NumberOfCells=\"" + std::to_string(cells.size()) +
                   "\">\n" + //
                   "<PointData>\n" + point_arrays + "</PointData>\n<CellData>\n" + cell_fields +
                   "</CellData>\n<Points>\n" + data_array("Points", 3, components<double>(X)) +
                   "</Points>\n<Cells>\n" + cell_arrays(cells) +
                   "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    }
  } // namespace

  void write_vtu(const std::string              &file,
                 const TetMesh                  &mesh,
                 const NodalVectors<double>     &X,
                 const std::vector<ScalarField> &nodal_scalars,
                 const std::vector<VectorField> &nodal_vectors,
                 const std::vector<ScalarField> &cell_scalars,
                 const std::vector<TensorField> &cell_tensors)
  {
    AssertThrow(X.size() == mesh.n_nodes(), dealii::ExcDimensionMismatch(X.size(), mesh.n_nodes()));
    write_grid(file,
               mesh.cells,
               X,
               arrays(nodal_scalars, 1, X.size()) + arrays(nodal_vectors, 3, X.size()),
               arrays(cell_scalars, 1, mesh.n_cells()) + arrays(cell_tensors, 6, mesh.n_cells()),
               symmetry(mesh));
  }

  void write_vtu(const std::string              &file,
                 const TriangleSurface          &surface,
                 const std::vector<VectorField> &vertex_vectors)
  {
    write_grid(
      file, surface.triangles(), surface.vertices(), arrays(vertex_vectors, 3, surface.vertices().size()));
  }
} // namespace retroforge
