#include "ui/panels/length_box.h"

#include <gtest/gtest.h>

#include <QLineEdit>
#include <QSignalSpy>
#include <QTest>

namespace lamella::ui {
namespace {

/// Types `text` over what the box holds.
void type(LengthBox& box, const QString& text) {
  auto* edit = box.findChild<QLineEdit*>();
  edit->selectAll();
  QTest::keyClicks(edit, text.isEmpty() ? QString() : text);
  if (text.isEmpty()) QTest::keyClick(edit, Qt::Key_Delete);
  QTest::keyClick(edit, Qt::Key_Return);
}

TEST(LengthBoxTest, SaysWhatAutomaticMeansUntilALengthIsTyped) {
  LengthBox box;
  box.set_automatic("automatic: 0.05 mm", 0.05);
  EXPECT_EQ(box.text(), "automatic: 0.05 mm");
  EXPECT_FALSE(box.length().has_value());
  type(box, "0.2");
  ASSERT_TRUE(box.length().has_value());
  EXPECT_DOUBLE_EQ(*box.length(), 0.2);
  EXPECT_EQ(box.text(), "0.2 mm");
}

TEST(LengthBoxTest, EmptyTextIsAutomaticAgain) {
  LengthBox box;
  box.set_length(0.5);
  QSignalSpy changed(&box, &QDoubleSpinBox::valueChanged);
  type(box, "");
  EXPECT_FALSE(box.length().has_value());
  EXPECT_EQ(changed.count(), 1);
}

TEST(LengthBoxTest, ArrowsBeginAtTheAutomaticLengthAndChangeByAShare) {
  LengthBox box;
  box.set_automatic("automatic", 0.08);
  box.stepBy(1);
  EXPECT_DOUBLE_EQ(*box.length(), 0.1);
  box.stepBy(-1);
  EXPECT_DOUBLE_EQ(*box.length(), 0.08);
  box.set_length(100);
  box.stepBy(1);
  EXPECT_DOUBLE_EQ(*box.length(), 125);
}

TEST(LengthBoxTest, WordsAreNotTaken) {
  LengthBox box;
  box.set_length(3);
  type(box, "wide");
  EXPECT_DOUBLE_EQ(*box.length(), 3);
  type(box, "-1");
  EXPECT_GT(*box.length(), 0);
}

}  // namespace
}  // namespace lamella::ui
