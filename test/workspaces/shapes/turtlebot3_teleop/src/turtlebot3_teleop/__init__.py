WHOSE = "the learner"
