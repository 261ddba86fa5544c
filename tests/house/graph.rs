//! Which file of a crate uses which, re-exports followed to the file that defines a name, and the circles among them.
//! It reads the module tree from the root file; what is not reachable from there is not part of the crate.

use super::source::{Source, read};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The files of one crate, and which of them each file uses.
pub struct Graph {
    /// Path of each file relative to the root of the repository, with forward slashes.
    pub files: Vec<String>,
    /// Files that each file uses, by index; not itself.
    pub uses: Vec<BTreeSet<usize>>,
}

struct Module {
    path: Vec<String>,
    file: String,
    source: Source,
}

struct Crate {
    modules: Vec<Module>,
    by_path: BTreeMap<Vec<String>, usize>,
}

/// What a path names.
enum Target {
    Module(usize),
    Item(usize),
}

impl Graph {
    /// The graph of the crate with this root file, `src/lib.rs` for one.
    pub fn of(repository: &Path, root: &str) -> Self {
        let mut all = Crate { modules: Vec::new(), by_path: BTreeMap::new() };
        all.load(repository, Path::new(root), Vec::new());
        let uses = (0..all.modules.len()).map(|m| all.used_by(m)).collect();
        Self { files: all.modules.into_iter().map(|m| m.file).collect(), uses }
    }

    /// Sets of two or more files that use each other in a circle, each sorted.
    pub fn circles(&self) -> Vec<Vec<String>> {
        let reach: Vec<BTreeSet<usize>> = (0..self.files.len()).map(|f| self.reachable(f)).collect();
        let mut circles = BTreeSet::new();
        for f in 0..self.files.len() {
            let mut circle: Vec<String> =
                reach[f].iter().filter(|g| reach[**g].contains(&f)).map(|g| self.files[*g].clone()).collect();
            circle.sort();
            circles.insert(circle);
        }
        circles.into_iter().filter(|c| c.len() > 1).collect()
    }

    /// Files that a file uses, directly or through others; itself only where a circle leads back to it.
    pub fn reachable(&self, file: usize) -> BTreeSet<usize> {
        let mut seen = BTreeSet::new();
        let mut open: Vec<usize> = self.uses[file].iter().copied().collect();
        while let Some(next) = open.pop() {
            if seen.insert(next) {
                open.extend(&self.uses[next]);
            }
        }
        seen
    }
}

impl Crate {
    fn load(&mut self, repository: &Path, file: &Path, path: Vec<String>) {
        let text = std::fs::read_to_string(repository.join(file)).unwrap();
        let source = read(&text);
        let name = file.file_stem().unwrap().to_string_lossy();
        let folder = if ["lib", "main", "mod"].contains(&name.as_ref()) {
            file.parent().unwrap().to_path_buf()
        } else {
            file.with_extension("")
        };
        let children = source.children.clone();
        self.by_path.insert(path.clone(), self.modules.len());
        self.modules.push(Module { path: path.clone(), file: file.to_string_lossy().replace('\\', "/"), source });
        for child in children {
            let beside: PathBuf = folder.join(format!("{child}.rs"));
            let within = folder.join(&child).join("mod.rs");
            let file = if repository.join(&beside).exists() { beside } else { within };
            let path = path.iter().cloned().chain([child]).collect();
            self.load(repository, &file, path);
        }
    }

    /// Files that a module's file uses. A re-export counts only where the file's own code names it.
    fn used_by(&self, module: usize) -> BTreeSet<usize> {
        let source = &self.modules[module].source;
        let mut found = BTreeSet::new();
        for used in source.uses.iter().filter(|u| !u.public || source.names.contains(&u.name)) {
            match self.resolve(module, &used.path, 0) {
                Some(Target::Item(file)) => drop(found.insert(file)),
                Some(Target::Module(file)) if used.name == "*" => drop(found.insert(file)),
                _ => {}
            }
        }
        for path in &source.paths {
            if let Some(Target::Item(file)) = self.resolve(module, path, 0) {
                found.insert(file);
            }
        }
        found.remove(&module);
        found
    }

    /// What a path names that is written in a module; `None` for what is not of this crate.
    fn resolve(&self, module: usize, path: &[String], depth: usize) -> Option<Target> {
        let (first, rest) = path.split_first().filter(|_| depth < 20)?;
        let here = &self.modules[module];
        match first.as_str() {
            "crate" => self.walk(0, rest, depth),
            "self" => self.walk(module, rest, depth),
            "super" => self.walk_up(module, rest, depth),
            name if here.source.children.iter().any(|c| c == name) => self.walk(module, path, depth),
            name => {
                let used = here.source.uses.iter().find(|u| u.name == name && u.path.first() != Some(first));
                let longer: Vec<String> = used?.path.iter().chain(rest).cloned().collect();
                self.resolve(module, &longer, depth + 1)
            }
        }
    }

    fn walk_up(&self, module: usize, rest: &[String], depth: usize) -> Option<Target> {
        let path = &self.modules[module].path;
        let parent = *self.by_path.get(&path[..path.len().checked_sub(1)?])?;
        match rest.split_first() {
            Some((next, rest)) if next == "super" => self.walk_up(parent, rest, depth),
            _ => self.walk(parent, rest, depth),
        }
    }

    /// Follows a path down from a module, and a name through re-exports to the file that defines it.
    fn walk(&self, module: usize, path: &[String], depth: usize) -> Option<Target> {
        let Some((name, rest)) = path.split_first() else { return Some(Target::Module(module)) };
        let here = &self.modules[module];
        let child: Vec<String> = here.path.iter().chain([name]).cloned().collect();
        if let Some(child) = self.by_path.get(&child) {
            return self.walk(*child, rest, depth);
        }
        if here.source.defined.contains(name) {
            return Some(Target::Item(module));
        }
        for used in here.source.uses.iter().filter(|u| u.name == *name || u.name == "*") {
            let last = if used.name == "*" { vec![name.clone()] } else { Vec::new() };
            let longer: Vec<String> = used.path.iter().chain(&last).chain(rest).cloned().collect();
            match self.resolve(module, &longer, depth + 1) {
                Some(Target::Item(file)) if used.name == "*" && !self.modules[file].source.defined.contains(name) => {}
                Some(target) => return Some(target),
                None => {}
            }
        }
        Some(Target::Item(module))
    }
}
