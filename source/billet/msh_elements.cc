// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/msh_elements.h>

#include <map>

namespace retroforge
{
  MshElement msh_element(const int type)
  {
    using S                                         = MshElement::Shape;
    static const std::map<int, MshElement> elements = {
      {1, {2, S::other, true}},          {2, {3, S::triangle, true}},       {3, {4, S::other, true}},
      {4, {4, S::tetrahedron, true}},    {5, {8, S::hexahedron, true}},     {6, {6, S::prism, true}},
      {7, {5, S::pyramid, true}},        {8, {3, S::other, false}},         {9, {6, S::triangle, false}},
      {10, {9, S::other, false}},        {11, {10, S::tetrahedron, false}}, {12, {27, S::hexahedron, false}},
      {13, {18, S::prism, false}},       {14, {14, S::pyramid, false}},     {15, {1, S::other, true}},
      {16, {8, S::other, false}},        {17, {20, S::hexahedron, false}},  {18, {15, S::prism, false}},
      {19, {13, S::pyramid, false}},     {20, {9, S::triangle, false}},     {21, {10, S::triangle, false}},
      {22, {12, S::triangle, false}},    {23, {15, S::triangle, false}},    {24, {15, S::triangle, false}},
      {25, {21, S::triangle, false}},    {26, {4, S::other, false}},        {27, {5, S::other, false}},
      {28, {6, S::other, false}},        {29, {20, S::tetrahedron, false}}, {30, {35, S::tetrahedron, false}},
      {31, {56, S::tetrahedron, false}}, {36, {16, S::other, false}},       {37, {25, S::other, false}},
      {42, {28, S::triangle, false}},    {71, {84, S::tetrahedron, false}}, {90, {40, S::prism, false}},
      {91, {75, S::prism, false}},       {118, {30, S::pyramid, false}},    {119, {55, S::pyramid, false}},
      {92, {64, S::hexahedron, false}},  {93, {125, S::hexahedron, false}}};
    const auto found = elements.find(type);
    return found == elements.end() ? MshElement() : found->second;
  }

  std::string name_of(const MshElement::Shape shape)
  {
    switch (shape)
    {
      case MshElement::Shape::tetrahedron:
        return "tetrahedra";
      case MshElement::Shape::hexahedron:
        return "hexahedra";
      case MshElement::Shape::prism:
        return "prisms";
      case MshElement::Shape::pyramid:
        return "pyramids";
      default:
        return "other elements";
    }
  }
} // namespace retroforge
