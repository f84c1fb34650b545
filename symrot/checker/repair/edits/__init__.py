"""Single edits of formulas: each undoes one fault that occurs in practice, such as a lost factor or a wrong sign."""
