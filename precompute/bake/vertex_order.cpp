namespace relume {}
