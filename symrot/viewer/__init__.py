"""Pages that move: a scene as one offline HTML file, whose motion is computed in the browser."""
