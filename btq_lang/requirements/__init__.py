"""What requirements mean: their clauses resolved, with units, subjects and scopes."""
