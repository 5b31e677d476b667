#include <set>

#include "app/window_services.h"
#include "core/io/msh.h"
#include "tests/support/three_bodies.h"
#include "tests/ui/window_fixture.h"

namespace lamella::ui {
namespace {

/// A window with the readers of the program, and a mesh of three bodies that touch.
class MeshBodies : public WindowFixture {
 protected:
  MeshBodies() : WindowFixture(with_readers) {
    const lamella::test::ThreeBodies three;
    EXPECT_TRUE(write_msh(three.mesh, {}, folder_ / "three.msh").ok());
  }
  static Services with_readers(Services made) {
    Services own = window_services({});
    made.load_parts = own.load_parts;
    made.read_mesh = own.read_mesh;
    made.formats = own.formats;
    return made;
  }
  QString file() { return QString::fromStdString((folder_ / "three.msh").string()); }
};

TEST_F(MeshBodies, AMeshIsOpenedToBeSeenAndAddedToBeMeshedAnew) {
  window_.open_files({file()});
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(session().has_bodies());
  EXPECT_EQ(session().iterations().size(), 1u);
  EXPECT_TRUE(action(Act::add)->isEnabled());

  window_.open_files({file()}, true);
  ASSERT_TRUE(wait_idle());
  ASSERT_EQ(session().parts().size(), 3u);
  EXPECT_EQ(session().parts()[1].name, "insert");
  EXPECT_TRUE(session().iterations().empty());
  EXPECT_TRUE(action(Act::run)->isEnabled());
  std::multiset<std::string> groups;
  for (const BoundaryGroup& group : study().groups) groups.insert(group.name);
  EXPECT_EQ(groups,
            (std::multiset<std::string>{"gate", "symmetry", "symmetry", "symmetry", "vent"}));
  if (const QString to = qEnvironmentVariable("LAMELLA_PICTURES"); !to.isEmpty()) {
    QTest::qWait(300);
    window_.grab().save(to + "/mesh-bodies.png");
  }

  action(Act::reload)->trigger();
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().parts().size(), 3u);
  EXPECT_EQ(study().groups.size(), 5u) << "once";
}

}  // namespace
}  // namespace lamella::ui
