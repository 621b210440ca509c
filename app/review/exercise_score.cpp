// The score of an exercise whose session is looked at.
#include "app/review/review_view.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/training/score_file.h"

namespace arthronaut::review {

// Of an exercise, from the user's list: by its session and the case that holds it.
void ReviewView::find_score() {
  OpenSession& open = *open_;
  if (!recording::is_exercise(open.review.session->header)) return;
  try {
    for (training::Score& score : training::read_training_file(training::training_file()))
      if (training::is_of_session(score, open.review.folder.filename(), model_->knee().name,
                                  model_->knee().created_utc))
        open.score = std::move(score);
  } catch (const std::runtime_error& error) {  // the session is shown without it
    notice_ = error.what();
  }
}

}  // namespace arthronaut::review
