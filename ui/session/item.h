#pragma once

namespace lamella::ui {

/// What the study tree lists: bodies and what is made on them.
enum class ItemKind { body, group, sizing, cut, domain };

/// One entry of the study, by its place in its list; there is one domain at most.
struct Item {
  ItemKind kind = ItemKind::body;
  int index = -1;

  bool operator==(const Item&) const = default;
};

}  // namespace lamella::ui
