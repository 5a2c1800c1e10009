"""The catalogue of stiff and extreme cases: what each must give, and what it gives."""
