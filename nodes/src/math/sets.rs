/// Disjoint sets of numbers (union-find). The root of a set is its least number.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sets {
    parents: Vec<u32>,
}

impl Sets {
    /// Forgets all numbers.
    pub fn clear(&mut self) {
        self.parents.clear();
    }

    /// Adds a set of the next number.
    pub fn add(&mut self) {
        self.parents.push(self.parents.len() as u32);
    }

    /// Number of numbers.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// Joins the sets of two numbers.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    /// Root of the set of a number. Halves the path for the next search.
    pub fn root(&mut self, mut number: u32) -> u32 {
        while self.parents[number as usize] != number {
            let parent = self.parents[number as usize];
            self.parents[number as usize] = self.parents[parent as usize];
            number = parent;
        }
        number
    }
}
